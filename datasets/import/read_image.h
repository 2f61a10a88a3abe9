// The images of a foreign set.
#pragma once

#include "base/linearize/linear_photo.h"
#include "datasets/import/foreign_set.h"
#include "datasets/import/import_set.h"

namespace glint {

struct PixelSize {
  int width, height;
};

// Of the part of an image that shows the sample. Throws UserError where the first image is smaller
// than what is to be cropped of it.
PixelSize SampleSize(const ForeignSet& set);

LinearPhoto ReadLinear(const ForeignView& view, const std::string& encoding_name,
                       const ImportOptions& options);

}  // namespace glint
