// Pictures inside the page, small enough to be looked at together.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "base/images/image.h"

namespace glint {

// Shrinks to at most `largest_side` pixels a side (area average); never enlarges.
Image Shrunk(const Image& image, int largest_side);
// The same of three planes, as channels R, G, B.
Image ShrunkPlanes(std::span<const float> rgb_planar, int width, int height, int largest_side);

// The image (one or three channels, display values, clamped to [0, 1]) as a JPEG file's bytes, and
// as a data: URI.
std::string JpegBytes(const Image& image, int quality);
std::string JpegUri(const Image& image, int quality = 88);
std::string PngUri(const Image& image);

// <img …> with an alternative text.
std::string ImageHtml(const std::string& uri, const std::string& alternative);

// Planar linear RGB to display values: times `gain`, gamma 2.2.
Image DisplayImage(std::span<const float> rgb_planar, int width, int height, float gain = 1);

// A scale of colours from dark blue (0) to yellow (1) for values that have no colour (viridis).
Image ColorMapped(std::span<const float> values, int width, int height, float low, float high);

}  // namespace glint
