"""Representative particles with weights and sizes, and the folder they are kept in (section 2.5)."""
