"""Files that the program writes itself and reads back: STL, tables, JSON, atomic files and folders."""
