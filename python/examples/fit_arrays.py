"""Fits maps to photographs in memory, and predicts one that was held out.

The photographs are renderings here, so that there is something to compare with; put your own top
views into `photographs`, and where camera and flash were into `cameras_mm` and `lights_mm`.

    python3 fit_arrays.py
"""

import argparse

import numpy as np

import glint

SIZE_MM = 60
LIGHT_RGB = 4e5  # radiance mm^2


def material(size):
    """Waves of two substances: a matt one, and a glossy one that bulges."""
    across = np.linspace(0, 6 * np.pi, size)
    wave = 0.5 + 0.5 * np.sin(across)[np.newaxis, :] * np.sin(across)[:, np.newaxis]
    glossy = (wave > 0.5)[..., np.newaxis]
    slope_x, slope_y = np.gradient(wave, axis=1), -np.gradient(wave, axis=0)
    normal = np.stack([-slope_x, -slope_y, np.ones_like(wave)], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    diffuse = np.where(glossy, (0.1, 0.15, 0.4), (0.5, 0.35, 0.2))
    return glint.Maps(normal, diffuse, np.where(wave > 0.5, 0.3, 0.7), 0.04, size_mm=SIZE_MM)


def places(count):
    """Cameras round the sample, and flashes 10 mm beside them, millimetres."""
    azimuth = 2 * np.pi * np.arange(count) / count
    tilt = np.radians(np.where(np.arange(count) == 0, 2, 22))
    cameras = 180 * np.stack([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth),
                              np.cos(tilt)], axis=-1)
    return cameras, cameras + (10, 0, 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=int, default=128, help="texels across")
    parser.add_argument("--photographs", type=int, default=7)
    options = parser.parse_args()

    truth = material(options.size)
    cameras_mm, lights_mm = places(options.photographs + 1)
    photographs = [glint.render(truth, camera, light, LIGHT_RGB)
                   for camera, light in zip(cameras_mm, lights_mm)]

    found = glint.fit(photographs[:-1], cameras_mm[:-1], lights_mm[:-1], size_mm=SIZE_MM,
                      light_rgb=LIGHT_RGB,
                      progress=lambda report: print(f"{report.label}: {100 * report.share:.0f} %"))

    predicted = glint.render(found.maps, cameras_mm[-1], lights_mm[-1], LIGHT_RGB)
    error = np.abs(np.log(predicted + 0.01) - np.log(photographs[-1] + 0.01)).mean()
    print(f"held-out photograph: log-L1 {error:.3f}")
    for name in ("diffuse", "roughness", "specular"):
        difference = getattr(found.maps, name) - getattr(truth, name)
        print(f"{name}: RMS error {np.sqrt(np.mean(difference**2)):.3f}, stated standard deviation "
              f"{getattr(found.confidence, name).mean():.3f}")


if __name__ == "__main__":
    main()
