"""Tests need REEB_PROGRAM, the program, and PYTHONPATH with the package that was built."""
