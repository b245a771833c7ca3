"""Blackhole GL: an interactive viewer of black holes whose pictures can be trusted."""

import os

# Read when NumPy is first imported, which takes 40 % longer where OpenBLAS starts a thread for each core: all our matrices are small.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

VERSION = "0.1.0"
