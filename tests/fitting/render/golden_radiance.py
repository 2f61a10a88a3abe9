"""Writes golden_radiance.csv: radiances of texels at the sample's centre, by the formulas as the paper and
docs/model.md have them, in Python's floats and without any of Glint's code.

Run it again only where the model itself changes: python3 golden_radiance.py > golden_radiance.csv
"""

import math
import random

CONVENTIONS = [
    "diffuse=one light=inverse_square sampling=pixel_centres",
    "diffuse=one light=none sampling=corner_to_corner",
    "diffuse=one_minus_specular light=inverse_square sampling=pixel_centres",
    "diffuse=one light=inverse_square sampling=pixel_centres narrow_lobe=0.4x0.3",
    "diffuse=one light=inverse_square sampling=pixel_centres narrow_lobe=0.7x0.25@0.04",
    "diffuse=one light=inverse_square sampling=pixel_centres tail=4",
    "diffuse=one light=inverse_square sampling=pixel_centres narrow_lobe=0.4x0.3 tail=8",
    "diffuse=one light=inverse_square sampling=pixel_centres anisotropy=2.5@30",
    "diffuse=one light=inverse_square sampling=pixel_centres narrow_lobe=0.4x0.3@0.04 tail=4 anisotropy=1.5@135",
]
ROWS_OF_EACH = 24


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


def fresnel(f0, v_dot_h):
    return f0 + (1 - f0) * 2 ** ((-5.55473 * v_dot_h - 6.98316) * v_dot_h)


def lobe(n, l, v, roughness, tail, ratio, direction_deg):
    """D·G / (4·NoL·NoV) of Student's t-distribution of slopes, which is GGX with tail 2. α is √ratio times as
    large along the direction, projected onto the texel's plane, and 1/√ratio across."""
    h = unit([a + b for a, b in zip(l, v)])
    azimuth = math.radians(direction_deg)
    g = [math.cos(azimuth), math.sin(azimuth), 0]
    along = unit([x - dot(n, g) * y for x, y in zip(g, n)])
    across = [n[1] * along[2] - n[2] * along[1], n[2] * along[0] - n[0] * along[2], n[0] * along[1] - n[1] * along[0]]
    tangent = ((dot(h, along) / dot(h, n)) ** 2 / ratio + (dot(h, across) / dot(h, n)) ** 2 * ratio)
    alpha = min(roughness, 1) ** 2
    k = alpha / 2
    square = dot(n, h) ** 2
    d = (tail - 1) ** tail * alpha ** (2 * tail - 2) / (math.pi * square**2)
    d /= ((tail - 1) * alpha**2 + tangent) ** tail
    g = math.prod(x / (x * (1 - k) + k) for x in (dot(n, l), dot(n, v)))
    return d * g / (4 * dot(n, l) * dot(n, v))


def radiance(convention, camera, light, power, ambient, exposure, n, diffuse, specular, roughness):
    words = dict(word.split("=") for word in convention.split())
    l, v = unit(light), unit(camera)
    h = unit([a + b for a, b in zip(l, v)])
    falloff = dot(light, light) if words["light"] == "inverse_square" else 1
    share, ratio, coat = 0.0, 1.0, 0.0
    tail = int(words.get("tail", 2))
    shape = [tail, *(float(x) for x in words.get("anisotropy", "1@0").split("@"))]
    if "narrow_lobe" in words:
        share, rest = words["narrow_lobe"].split("x")
        ratio, _, coat = rest.partition("@")
        share, ratio, coat = float(share), float(ratio), float(coat or 0)
    wide = (1 - share) * lobe(n, l, v, roughness * ratio**-share, *shape)
    narrow = share * lobe(n, l, v, roughness * ratio ** (1 - share), *shape) if share else 0.0
    result = []
    for c in range(3):
        weight = 1 - specular[c] if words["diffuse"] == "one_minus_specular" else 1
        narrow_f0 = coat if coat else specular[c]
        f = weight * diffuse[c] / math.pi
        f += wide * fresnel(specular[c], dot(v, h)) + narrow * fresnel(narrow_f0, dot(v, h))
        around = (1 - share) * specular[c] + share * narrow_f0
        reflected = ambient[c] * (weight * diffuse[c] + around) / math.pi
        result.append(exposure * (power[c] / falloff * f * dot(n, l) + reflected))
    return result


def place(generator, height):
    return [round(generator.uniform(-0.6, 0.6) * height, 1) for _ in range(2)] + [float(height)]


def main():
    generator = random.Random(20190701)
    print("convention,camera_mm,light_mm,light_rgb,ambient_rgb,exposure,normal,diffuse,specular,roughness,radiance")
    for convention in CONVENTIONS:
        for row in range(ROWS_OF_EACH):
            camera = place(generator, 300)
            light = [x + round(generator.uniform(-20, 20), 1) for x in camera] if row % 2 else place(generator, 350)
            near = unit([generator.uniform(-0.5, 0.5), generator.uniform(-0.5, 0.5), 1.0])
            # Every third texel mirrors the light, nearly.
            half = unit([a + b for a, b in zip(unit(light), unit(camera))])
            n = unit([h + generator.uniform(-0.03, 0.03) for h in half]) if row % 3 == 0 else near
            n = unit([round(x, 4) for x in n])
            power = [round(generator.uniform(1, 4) * (1e5 if "inverse" in convention else 1), 1) for _ in range(3)]
            ambient = [round(generator.uniform(0, 0.3), 3) for _ in range(3)]
            diffuse = [round(generator.uniform(0, 0.9), 3) for _ in range(3)]
            specular = [round(generator.uniform(0.02, 0.08 if row % 4 else 0.95), 3) for _ in range(3)]
            roughness = round(generator.uniform(0.08, 0.9), 3)
            exposure = round(generator.uniform(0.5, 2), 3)
            given = (camera, light, power, ambient, exposure, n, diffuse, specular, roughness)
            fields = [*given, radiance(convention, *given)]
            texts = [" ".join(repr(x) for x in field) if isinstance(field, list) else repr(field) for field in fields]
            print(",".join([convention, *texts]))


if __name__ == "__main__":
    main()
