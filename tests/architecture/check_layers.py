#!/usr/bin/env python3
"""Checks that #include only points down the layers: check_layers.py [ROOT].

Layers and their modules, bottom to top, are the table below; docs/architecture.md says what lives in
each. A source may include its own module, modules listed before it in its layer, and all lower layers.
A layer's own sources (programs' mains) may include every module of the layer. Tests may include all.
Prints every include that goes up, and folders that the table does not know; exits 1 if any.
"""

import pathlib
import re
import sys

LAYERS = {
    "base": "errors text model colour statistics cpu memory parallel resampling reflectance files images canvas "
    "photos camera board stages formats programs linearize",
    "calib": "chart registration printing corners bundle uncertainty validation light moving_light response "
    "triage colmap guidance capture",
    "rectify": "resample views",
    "fitting": "encoding weights photographs layers render autoencoder estimator rectified_photographs relief "
    "shadows initial_maps latent texel view_correction refine tiling",
    "datasets": "procedural material_pack map_formats import synth statistics looks evaluation",
    "training": "",
    "pipeline": "driver export viewer report overview studio",
    "python": "",
}
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')


def places():
    """(layer, module) to its height; "" is a layer's own sources, above its modules."""
    order = []
    for layer, modules in LAYERS.items():
        order += [(layer, module) for module in [*modules.split(), ""]]
    return {place: height for height, place in enumerate(order)}


def place_of(path):
    """The layer and module of a path relative to the root; None outside the layers."""
    parts = path.split("/")
    if parts[0] not in LAYERS or len(parts) < 2:
        return None
    has_modules = bool(LAYERS[parts[0]])
    return parts[0], parts[1] if has_modules and len(parts) > 2 else ""


def findings(root):
    height = places()
    for layer in LAYERS:
        for source in sorted((root / layer).rglob("*")):
            if source.suffix not in {".h", ".cc", ".inl"}:
                continue
            path = source.relative_to(root).as_posix()
            if "node_modules/" in path:
                continue
            here = place_of(path)
            if here not in height:
                yield f"{path}: {'/'.join(here)} is not in the table of tests/architecture/check_layers.py"
                continue
            for number, line in enumerate(source.read_text(encoding="utf-8").splitlines(), 1):
                found = INCLUDE.match(line)
                there = found and place_of(found[1])
                if not there:
                    continue
                if there not in height:
                    yield f"{path}:{number}: includes {found[1]}, which is in no module of the table"
                elif height[there] > height[here]:
                    yield f"{path}:{number}: includes {found[1]}, which lies above {'/'.join(filter(None, here))}"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    upward = list(findings(root))
    print("\n".join(upward) if upward else "every include points down")
    return 1 if upward else 0


if __name__ == "__main__":
    sys.exit(main())
