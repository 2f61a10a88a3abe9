#!/usr/bin/env python3
"""Checks that #include goes down the house only: check_floors.py [ROOT].

Floors and their rooms, bottom to top, are the table below; docs/architecture.md says what lives in
each. A source may include its own room, rooms listed before it on its floor, and all lower floors.
A floor's own sources (programs' mains) may include every room of the floor. Tests may include all.
Prints every include that goes up, and folders that the table does not know; exits 1 if any.
"""

import pathlib
import re
import sys

FLOORS = {
    "base": "errors text model colour statistics cpu memory parallel resampling reflectance files images canvas "
    "photos camera board stages formats programs linearize",
    "calib": "chart registration printing corners bundle uncertainty validation light moving_light response "
    "triage colmap guidance capture",
    "rectify": "resample views",
    "fitting": "encoding weights photographs layers render autoencoder estimator rectified_photographs relief "
    "initial_maps latent texel view_correction refine tiling",
    "datasets": "procedural material_pack map_formats import synth statistics looks evaluation",
    "training": "",
    "pipeline": "driver export viewer report overview studio",
    "python": "",
}
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')


def places():
    """(floor, room) to its height; "" is a floor's own sources, above its rooms."""
    order = []
    for floor, rooms in FLOORS.items():
        order += [(floor, room) for room in [*rooms.split(), ""]]
    return {place: height for height, place in enumerate(order)}


def place_of(path):
    """The floor and room of a path relative to the root; None outside the house."""
    parts = path.split("/")
    if parts[0] not in FLOORS or len(parts) < 2:
        return None
    has_rooms = bool(FLOORS[parts[0]])
    return parts[0], parts[1] if has_rooms and len(parts) > 2 else ""


def findings(root):
    height = places()
    for floor in FLOORS:
        for source in sorted((root / floor).rglob("*")):
            if source.suffix not in {".h", ".cc", ".inl"}:
                continue
            path = source.relative_to(root).as_posix()
            if "node_modules/" in path:
                continue
            here = place_of(path)
            if here not in height:
                yield f"{path}: {'/'.join(here)} is no room of the table in tests/floors/check_floors.py"
                continue
            for number, line in enumerate(source.read_text(encoding="utf-8").splitlines(), 1):
                found = INCLUDE.match(line)
                there = found and place_of(found[1])
                if not there:
                    continue
                if there not in height:
                    yield f"{path}:{number}: includes {found[1]}, in no room that is known"
                elif height[there] > height[here]:
                    yield f"{path}:{number}: includes {found[1]}, which lies above {'/'.join(filter(None, here))}"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    upward = list(findings(root))
    print("\n".join(upward) if upward else "every include goes down")
    return 1 if upward else 0


if __name__ == "__main__":
    sys.exit(main())
