"""Types of the extension module (python/module.cc)."""

from typing import Optional, Sequence

import numpy as np
from numpy.typing import NDArray

__version__: str

def read_exr(file: str, channels: Optional[list[str]] = None
             ) -> tuple[NDArray[np.float32], list[str], dict[str, str]]: ...
def write_exr(file: str, planes: NDArray[np.float32], channels: list[str],
              attributes: dict[str, str]) -> None: ...
def write_png(file: str, planes: NDArray[np.float32], bits: int) -> None: ...
def stages() -> list[str]: ...
def hash_file(file: str) -> str: ...
def convention(text: str) -> str: ...
def render(maps: NDArray[np.float32], size_mm: Sequence[float], convention: str,
           camera_mm: Sequence[float], light_mm: Sequence[float], light_rgb: Sequence[float],
           ambient_rgb: Sequence[float], exposure: float, threads: int
           ) -> NDArray[np.float32]: ...
def render_gradients(maps: NDArray[np.float32], radiance_gradient: NDArray[np.float32],
                     size_mm: Sequence[float], convention: str, camera_mm: Sequence[float],
                     light_mm: Sequence[float], light_rgb: Sequence[float],
                     ambient_rgb: Sequence[float], exposure: float, threads: int
                     ) -> NDArray[np.float32]: ...
def brdf(light: NDArray[np.float64], camera: NDArray[np.float64], normal: NDArray[np.float64],
         diffuse: NDArray[np.float64], specular: NDArray[np.float64],
         roughness: NDArray[np.float64], one_minus_specular: bool, narrow_share: float,
         narrow_ratio: float, coat_f0: float) -> NDArray[np.float64]: ...
