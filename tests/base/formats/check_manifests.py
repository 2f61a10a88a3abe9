#!/usr/bin/python3
"""Checks manifests against base/formats/manifest.schema.json: check_manifests.py SCHEMA PATH...

A PATH is a manifest or a folder searched for manifest.json files. Exit 1: one breaks the schema;
exit 2: no manifest was found.
"""
import json
import pathlib
import sys

import jsonschema


def manifests(paths):
    for path in map(pathlib.Path, paths):
        if path.is_dir():
            yield from sorted(path.rglob("manifest.json"))
        else:
            yield path


def main():
    schema = json.loads(pathlib.Path(sys.argv[1]).read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    checked, broken = 0, 0
    for path in manifests(sys.argv[2:]):
        checked += 1
        for error in validator.iter_errors(json.loads(path.read_text())):
            broken += 1
            print(f"{path}: {'/'.join(map(str, error.absolute_path))}: {error.message[:300]}")
    print(f"{checked} manifests checked, {broken} faults")
    sys.exit(2 if checked == 0 else 1 if broken else 0)


main()
