"""General widgets: number sliders, combo boxes, forms, tables, plots, messages."""
