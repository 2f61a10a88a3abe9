#!/usr/bin/python3
"""One synthetic capture as photographs of four colour spaces in four formats, each run to refined
maps; prints dE00 of its diffuse map against that of the sRGB run of the same format, and against
the sRGB run of 16-bit TIFF.

    tests/e2e/colour_spaces.py build/bin FOLDER [--resolution 96] [--photos 5] [--megapixels 1.5]

Needs python3-openimageio, python3-numpy, exiftool and heif-enc (libheif-examples). Results that are
there are taken again. Ends with exit code 1 where a mean is above 1.
"""
import argparse
import os
import pathlib
import shutil
import struct
import subprocess
import sys

import numpy as np
import OpenImageIO as oiio

D50 = (0.9642, 1.0, 0.8249)
# CIE xy of R, G, B and white; the curve's gamma, 0: sRGB's.
SPACES = {
    "sRGB": ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06), (0.3127, 0.3290), 0),
    "Display P3": ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), (0.3127, 0.3290), 0),
    "Adobe RGB": ((0.64, 0.33), (0.21, 0.71), (0.15, 0.06), (0.3127, 0.3290), 563 / 256),
    "ProPhoto": ((0.7347, 0.2653), (0.1596, 0.8404), (0.0366, 0.0001), (0.3457, 0.3585), 1.8),
}
FORMATS = {"TIFF 16": "tif", "PNG 16": "png", "JPEG 8": "jpg", "HEIC 8": "heic"}


def xyz_of(xy):
    return np.array([xy[0] / xy[1], 1, (1 - xy[0] - xy[1]) / xy[1]])


def d50_from_rgb(space):
    """XYZ under D50 of linear R, G, B: primaries scaled to their white, adapted by Bradford."""
    red, green, blue, white, _ = SPACES[space]
    columns = np.column_stack([xyz_of(p) for p in (red, green, blue)])
    matrix = columns * np.linalg.solve(columns, xyz_of(white))
    bradford = np.array(
        [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]])
    gains = (bradford @ np.array(D50)) / (bradford @ xyz_of(white))
    return np.linalg.inv(bradford) @ np.diag(gains) @ bradford @ matrix


def encoded(linear, gamma):
    linear = np.clip(linear, 0, 1)
    if gamma:
        return linear ** (1 / gamma)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def icc_of(space):
    """A profile of three primaries and a curve (ICC.1:2001)."""
    s15 = lambda v: struct.pack(">i", int(round(v * 65536)))
    gamma = SPACES[space][4]
    if gamma:
        curve = b"curv" + bytes(4) + struct.pack(">IH", 1, int(round(gamma * 256)))
    else:
        codes = np.linspace(0, 1, 1024)
        linear = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
        curve = b"curv" + bytes(4) + struct.pack(">I", 1024)
        curve += np.round(65535 * linear).astype(">u2").tobytes()
    name = space.encode() + b"\0"
    tags = [(b"desc", b"desc" + bytes(4) + struct.pack(">I", len(name)) + name + bytes(78)),
            (b"cprt", b"text" + bytes(4) + b"none\0"),
            (b"wtpt", b"XYZ " + bytes(4) + b"".join(map(s15, D50)))]
    for tag, column in zip((b"rXYZ", b"gXYZ", b"bXYZ"), d50_from_rgb(space).T):
        tags.append((tag, b"XYZ " + bytes(4) + b"".join(map(s15, column))))
    tags += [(tag, curve) for tag in (b"rTRC", b"gTRC", b"bTRC")]
    table, body = struct.pack(">I", len(tags)), b""
    start = 128 + 4 + 12 * len(tags)
    for tag, content in tags:
        content += bytes(-len(content) % 4)
        table += tag + struct.pack(">II", start + len(body), len(content))
        body += content
    head = struct.pack(">I4sI4s4s4s", start + len(body), b"none", 0x02400000, b"mntr", b"RGB ",
                       b"XYZ ")
    head += bytes(12) + b"acsp" + bytes(28) + b"".join(map(s15, D50))
    return head.ljust(128, b"\0") + table + body


def write(file, samples, icc, kind):
    spec = oiio.ImageSpec(samples.shape[1], samples.shape[0], 3, kind)
    spec.attribute("ICCProfile", oiio.TypeDesc(f"uint8[{len(icc)}]"),
                   np.frombuffer(icc, dtype=np.uint8))
    spec["Compression"] = "jpeg:95" if file.suffix == ".jpg" else "zip"
    output = oiio.ImageOutput.create(str(file))
    assert output.open(str(file), spec), oiio.geterror()
    assert output.write_image(np.ascontiguousarray(samples, dtype=np.float32)), output.geterror()
    output.close()


def make(base, folder, space, ending):
    """The base's photographs in a space and format, with the base's EXIF."""
    (folder / "photos").mkdir(parents=True)
    toml = (base / "capture.toml").read_text().replace("*.exr", "*." + ending)
    lines = [line for line in toml.splitlines() if not line.startswith("encoding")]
    (folder / "capture.toml").write_text("\n".join(lines) + "\n")
    matrix = np.linalg.inv(d50_from_rgb(space)) @ d50_from_rgb("sRGB")
    for source in sorted((base / "photos").glob("*.exr")):
        linear = oiio.ImageBuf(str(source)).get_pixels(oiio.FLOAT)[:, :, :3]
        stored = encoded(linear @ matrix.T, SPACES[space][4])
        file = folder / "photos" / (source.stem + "." + ending)
        icc = icc_of(space)
        if ending == "heic":
            through = folder / "through.png"
            write(through, stored, icc, "uint8")
            subprocess.check_call(["heif-enc", "-q", "95", str(through), "-o", str(file)],
                                  stdout=subprocess.DEVNULL)
            through.unlink()
        else:
            write(file, stored, icc, "uint8" if ending == "jpg" else "uint16")


def refined(programs, folder):
    environment = dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}")
    for stage in (["calib"], ["rectify"], ["fit", "--method", "initial"], ["refine"]):
        command = [f"{programs}/glint-{stage[0]}", str(folder), *stage[1:], "--log-level", "error"]
        subprocess.check_call(command, env=environment, stdout=subprocess.DEVNULL)
    maps = oiio.ImageBuf(str(folder / "glint/refine/svbrdf.exr"))
    names = list(maps.spec().channelnames)
    pixels = maps.get_pixels(oiio.FLOAT)
    return np.stack([pixels[:, :, names.index("diffuse." + c)] for c in "RGB"], axis=-1)


def lab_of(rgb):
    """CIELAB under D65 of linear Rec.709."""
    xyz = rgb @ np.array([[0.4124564, 0.2126729, 0.0193339], [0.3575761, 0.7151522, 0.1191920],
                          [0.1804375, 0.0721750, 0.9503041]])
    t = xyz / np.array([0.95047, 1.0, 1.08883])
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    return np.stack([116 * f[..., 1] - 16, 500 * (f[..., 0] - f[..., 1]),
                     200 * (f[..., 1] - f[..., 2])], axis=-1)


def delta_e00(lab1, lab2):
    """Sharma, Wu and Dalal 2005."""
    (l1, a1, b1), (l2, a2, b2) = (np.moveaxis(lab, -1, 0) for lab in (lab1, lab2))
    mean_c7 = ((np.hypot(a1, b1) + np.hypot(a2, b2)) / 2) ** 7
    g = 0.5 * (1 - np.sqrt(mean_c7 / (mean_c7 + 25.0 ** 7)))
    a1, a2 = (1 + g) * a1, (1 + g) * a2
    c1, c2 = np.hypot(a1, b1), np.hypot(a2, b2)
    h1, h2 = np.degrees(np.arctan2(b1, a1)) % 360, np.degrees(np.arctan2(b2, a2)) % 360
    dh = (h2 - h1 + 180) % 360 - 180
    dh = np.where(c1 * c2 == 0, 0, dh)
    dbig = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(dh) / 2)
    mean_l, mean_c = (l1 + l2) / 2, (c1 + c2) / 2
    mean_h = np.where(c1 * c2 == 0, h1 + h2, (h1 + dh / 2) % 360)
    t = (1 - 0.17 * np.cos(np.radians(mean_h - 30)) + 0.24 * np.cos(np.radians(2 * mean_h)) +
         0.32 * np.cos(np.radians(3 * mean_h + 6)) - 0.20 * np.cos(np.radians(4 * mean_h - 63)))
    rc = 2 * np.sqrt(mean_c ** 7 / (mean_c ** 7 + 25.0 ** 7))
    sl = 1 + 0.015 * (mean_l - 50) ** 2 / np.sqrt(20 + (mean_l - 50) ** 2)
    sc, sh = 1 + 0.045 * mean_c, 1 + 0.015 * mean_c * t
    rt = -rc * np.sin(2 * np.radians(30 * np.exp(-(((mean_h - 275) / 25) ** 2))))
    lightness, chroma, hue = (l2 - l1) / sl, (c2 - c1) / sc, dbig / sh
    return np.sqrt(lightness ** 2 + chroma ** 2 + hue ** 2 + rt * chroma * hue)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("programs")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--resolution", default="96")
    parser.add_argument("--photos", default="5")
    parser.add_argument("--megapixels", default="1.5")
    parser.add_argument("--family", default="leather")
    o = parser.parse_args()
    programs = os.path.abspath(o.programs)
    base = o.folder / "base"
    if not base.exists():
        subprocess.check_call([
            f"{programs}/glint-synth", "capture", str(base), "--family", o.family, "--seed", "3",
            "--format", "exr", "--photos", o.photos, "--megapixels", o.megapixels, "--texels",
            "256", "--resolution", o.resolution], stdout=subprocess.DEVNULL)
    maps = {}
    print(f"{'':12} {'format':8} {'diffuse':>20}  dE00, mean (95 %), against sRGB of the same "
          "format, and of TIFF")
    worst = 0
    for name, ending in FORMATS.items():
        for space in SPACES:
            folder = o.folder / (space.replace(" ", "") + "-" + name.replace(" ", ""))
            if not (folder / "photos").exists():
                try:
                    make(base, folder, space, ending)
                except BaseException:
                    shutil.rmtree(folder)
                    raise
            maps[space, name] = refined(programs, folder)
            lab = lab_of(maps[space, name])
            same = delta_e00(lab, lab_of(maps["sRGB", name]))
            tiff = delta_e00(lab, lab_of(maps["sRGB", "TIFF 16"]))
            worst = max(worst, same.mean())
            colour = " ".join(f"{v:.4f}" for v in maps[space, name].mean(axis=(0, 1)))
            figures = "  ".join(
                f"{d.mean():5.2f} ({np.percentile(d, 95):.2f})" for d in (same, tiff))
            print(f"{space:12} {name:8} {colour:>20}  {figures}", flush=True)
    return 1 if worst > 1 else 0


if __name__ == "__main__":
    sys.exit(main())
