"""Style sheet of the page: the controls stand beside the views, or below them on a narrow page."""

STYLE = """
html, body, #app { height: 100%; margin: 0; }
body { font: 14px/1.4 system-ui, sans-serif; color: #2b2f36; background: #f4f6f8; }
.page { display: flex; height: 100vh; }
.views { flex: 1; display: flex; flex-direction: column; min-width: 0; }
.titles { display: flex; }
.titles > div { flex: 1; padding: 6px 8px; text-align: center; min-width: 0; }
.picture { flex: 1; min-height: 240px; position: relative; }
.controls { width: 372px; box-sizing: border-box; padding: 10px 14px; overflow-y: auto; background: #fff; }
.controls { border-left: 1px solid #d5dbe1; }
.control { display: block; margin-bottom: 10px; }
.control > span { display: block; margin-bottom: 2px; }
.control > input, .control > select { width: 100%; box-sizing: border-box; font: inherit; }
.status { color: #56606c; min-height: 1.4em; }
.verdict { margin: 6px 0 10px; }
table { border-collapse: collapse; width: 100%; font-size: 12.5px; font-variant-numeric: tabular-nums; }
th, td { text-align: right; padding: 2px 4px; border-bottom: 1px solid #e4e8ec; }
td:first-child { text-align: left; white-space: nowrap; }
@media (max-width: 900px) {
  .page { flex-direction: column; height: auto; min-height: 100vh; }
  .picture { height: 46vh; flex: none; }
  .controls { width: auto; border-left: 0; }
}
"""
