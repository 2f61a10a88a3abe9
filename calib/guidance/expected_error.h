// What more photographs bring, as a rough figure.
#pragma once

namespace glint {

// Mean squared errors of finished maps against the number of photographs: docs/results/table1.md
// on procedural materials, rows "refined" (1, 2, 5, 20 views from random places up to 38° off
// the top), logarithms interpolated over the logarithm of N. Real materials differ by factors; the
// ratio of two numbers of photographs is what can be relied on.
struct ExpectedError {
  double maps = 0;    // average of the four maps
  double render = 0;  // of renderings under novel views and lights
};
// Beyond 1 … 20 the nearer end.
ExpectedError ErrorForPhotos(double photos);

}  // namespace glint
