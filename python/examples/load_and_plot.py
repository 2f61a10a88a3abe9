"""Loads a capture's maps and views, prints what is known of them, and plots them on a sheet.

    python3 load_and_plot.py wood sheet.png
    python3 load_and_plot.py wood --show     (needs matplotlib)
"""

import argparse

import numpy as np

import glint


def panels(maps, confidence):
    """What the sheet shows: titles and pictures H x W x 3, as a screen shows them."""
    def grey(values):
        return np.repeat(values[..., np.newaxis], 3, axis=-1)
    shown = {
        "normal": 0.5 * maps.normal + 0.5,
        "diffuse": glint.to_srgb(maps.diffuse),
        "roughness": grey(maps.roughness),
        "specular": glint.to_srgb(maps.specular),
    }
    if confidence is not None:
        shown["roughness, 1 sigma x 10"] = grey(np.clip(10 * confidence.roughness, 0, 1))
    return shown


def show(pictures):
    import matplotlib.pyplot as plot
    _, axes = plot.subplots(1, len(pictures), figsize=(4 * len(pictures), 4))
    for axis, (title, picture) in zip(axes, pictures.items()):
        axis.imshow(picture)
        axis.set_title(title)
        axis.axis("off")
    plot.show()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("capture")
    parser.add_argument("sheet", nargs="?", default="sheet.png", help="PNG to write")
    parser.add_argument("--stage", default="refine", help="stage whose maps to show: refine or fit")
    parser.add_argument("--show", action="store_true", help="show a window instead")
    options = parser.parse_args()

    capture = glint.Capture(options.capture)
    maps = capture.maps(options.stage)
    try:
        confidence = capture.confidence(options.stage)
    except glint.UserError:
        confidence = None
    height, width = maps.shape
    print(f"{width} x {height} texels of {maps.size_mm[0]:g} x {maps.size_mm[1]:g} mm")
    for name in capture.views:
        view = capture.view(name)
        print(f"{name}: camera at {np.round(view.camera_in_sample_mm)} mm, "
              f"{100 * view.mask.mean():.0f} % usable")

    pictures = panels(maps, confidence)
    if options.show:
        show(pictures)
        return
    glint.write_png(options.sheet, np.concatenate(list(pictures.values()), axis=1),
                    encoding="linear")
    print(f"{options.sheet}: {', '.join(pictures)}")


if __name__ == "__main__":
    main()
