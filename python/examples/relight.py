"""Relights a material: one frame for each place of a lamp that circles above the sample.

    python3 relight.py wood frames --frames 60
    ffmpeg -i frames/frame_%03d.png wood.mp4
"""

import argparse
import pathlib

import numpy as np

import glint


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("capture")
    parser.add_argument("folder", type=pathlib.Path, help="folder for the frames (PNG files)")
    parser.add_argument("--frames", type=int, default=24)
    parser.add_argument("--elevation-deg", type=float, default=50, help="elevation of the lamp")
    options = parser.parse_args()

    maps = glint.Capture(options.capture).maps()
    distance_mm = 3 * max(maps.size_mm)
    camera_mm = (0, 0, distance_mm)
    elevation = np.radians(options.elevation_deg)
    # The lamp's power is that with which white paper would be white.
    light_rgb = glint.white_light_rgb((0, 0, distance_mm), maps.convention)
    options.folder.mkdir(parents=True, exist_ok=True)
    for frame in range(options.frames):
        azimuth = 2 * np.pi * frame / options.frames
        light_mm = distance_mm * np.array([np.cos(elevation) * np.cos(azimuth),
                                           np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
        image = glint.render(maps, camera_mm, light_mm, light_rgb)
        glint.write_png(options.folder / f"frame_{frame:03}.png", image)
    print(f"{options.frames} frames in {options.folder}")


if __name__ == "__main__":
    main()
