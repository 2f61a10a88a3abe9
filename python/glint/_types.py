"""Types that signatures share."""

import os
from typing import Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float32]
Doubles = NDArray[np.float64]
Path = Union[str, "os.PathLike[str]"]

__all__ = ["ArrayLike", "Doubles", "Floats", "Path"]
