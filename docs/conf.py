"""The user guide: ``python -m sphinx -W docs build/docs``."""

from collections.abc import Iterator

import click
import typer
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from regolith_studio import __version__
from regolith_studio.cli.commands import app
from regolith_studio.guide import with_results

project = "Regolith Studio"
project_copyright = "the Regolith Studio developers"
release = __version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.mathjax"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
exclude_patterns = ["build"]
html_theme = "furo"
html_title = f"{project} {release}"
autodoc_typehints = "description"
autodoc_member_order = "bysource"
napoleon_google_docstring = False


class Commands(SphinxDirective):
    """What every command says of itself with --help."""

    def run(self) -> list[nodes.Node]:
        sections: list[nodes.Node] = []
        for title, text in _helps(typer.main.get_command(app), "regolith-studio"):
            section = nodes.section(ids=[nodes.make_id(title)])
            section += nodes.title(text=title)
            section += nodes.literal_block(text=text, language="text")
            sections.append(section)
        return sections


def _helps(command: click.Command, path: str) -> Iterator[tuple[str, str]]:
    context = click.Context(command, info_name=path, max_content_width=100)
    yield path, command.get_help(context)
    for name, below in getattr(command, "commands", {}).items():
        yield from _helps(below, f"{path} {name}")


def _fill_in_results(_sphinx: Sphinx, _page: str, source: list[str]) -> None:
    source[0] = with_results(source[0])


def setup(sphinx: Sphinx) -> None:
    sphinx.connect("source-read", _fill_in_results)
    sphinx.add_directive("commands", Commands)
