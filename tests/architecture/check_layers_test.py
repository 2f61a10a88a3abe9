#!/usr/bin/env python3
"""An upward include, between layers and between modules, and an unknown module are each found."""

import pathlib
import tempfile
import unittest

import check_layers


class Layers(unittest.TestCase):
    def found(self, path, include):
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder) / path
            source.parent.mkdir(parents=True)
            source.write_text(f'#include <vector>\n#include "{include}"\n')
            return list(check_layers.findings(pathlib.Path(folder)))

    def test_down_is_allowed(self):
        self.assertEqual(self.found("fitting/texel/a.cc", "base/reflectance/view.h"), [])
        self.assertEqual(self.found("fitting/refine/a.cc", "fitting/texel/texel.h"), [])
        self.assertEqual(self.found("fitting/main_fit.cc", "fitting/latent/fit.h"), [])

    def test_a_higher_layer_is_found(self):
        self.assertEqual(
            self.found("base/reflectance/a.h", "fitting/texel/texel.h"),
            ["base/reflectance/a.h:2: includes fitting/texel/texel.h, which lies above base/reflectance"],
        )

    def test_a_higher_module_is_found(self):
        self.assertEqual(len(self.found("fitting/texel/a.cc", "fitting/refine/refine.h")), 1)

    def test_an_unknown_module_is_found(self):
        self.assertEqual(len(self.found("fitting/attic/a.cc", "base/reflectance/view.h")), 1)
        self.assertEqual(len(self.found("fitting/texel/a.cc", "base/attic/a.h")), 1)


if __name__ == "__main__":
    unittest.main()
