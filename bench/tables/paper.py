"""Figures of the paper: V. Pascucci, G. Scorzelli, P.-T. Bremer, A. Mascarenhas, Robust On-line Computation of Reeb
Graphs: Simplicity and Speed, SIGGRAPH 2007, tables 2 and 3."""

MACHINE = "a MacBook Pro with a 2.3 GHz Intel dual core processor and 2 GB of memory"

# By our size: model, average time of reasonable functions, time of a random function, load, memory out of core,
# triangles.
SIZES = {"0.87M": ("dragon", "1.0 s", "1.8 s", "0.8 s", "0.1 MB", 871e3),
         "7.2M": ("Asian dragon", "8.7 s", "23 s", "7.4 s", "0.5 MB", 7.2e6),
         "28M": ("Lucy", "48 s", "101 s", "47 s", "2.1 MB", 28e6),
         "56M": ("David", "108 s", "218 s", "94 s", "2.1 MB", 56e6),
         "372M": ("St. Matthew", "486 s", "1448 s", "311 s", "8.4 MB", 372e6)}
# Model, triangles, conversion, and time / memory for x, y, z and a random function, in the original order.
ORIGINAL_ORDER = [
    ("dragon", "871,000", "4.5 s", "2.2 s / 1.0 MB", "2.2 s / 1.0 MB", "2.3 s / 1.0 MB", "2.2 s / 1.0 MB"),
    ("Asian dragon", "7.2 million", "28 s", "16 s / 16 MB", "16 s / 16 MB", "16 s / 16 MB", "16 s / 16 MB"),
    ("Lucy", "28 million", "72 s", "1.8 min / 94 MB", "1.8 min / 94 MB", "1.8 min / 94 MB", "1.7 min / 94 MB"),
    ("David", "56 million", "2.6 min", "2.1 min / 8.3 MB", "2.2 min / 8.3 MB", "14 min / 528 MB", "2.1 min / 8.3 MB"),
    ("St. Matthew", "372 million", "25 min", "15 min / 8.3 MB", "3.8 h / 376 MB", "16 min / 16 MB",
     "15 min / 8.3 MB")]
