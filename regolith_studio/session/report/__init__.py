"""The report on a sample: Figs. 2 to 9 and Tables 1 and 2 of the paper, as one page."""
