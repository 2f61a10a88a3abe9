#include <gtest/gtest.h>

#include <limits>

#include "fitting/refine/refine_metrics.h"
#include "tests/support/generated_block.h"

namespace glint {
namespace {

TEST(ManifestPage, HoldsTheMetricsThatRefinementWrites) {
  test::CompareOrUpdate(
      "docs/manifest.md", "metrics of refine",
      "| field | |\n|---|---|\n" + FieldRows(TexelMetrics()) + FieldRows(SampleMetrics()));
}

TEST(ManifestPage, WhatIsNotKnownIsNull) {
  RefineSummary summary;
  summary.diffuse_spread = std::numeric_limits<double>::infinity();
  const Json json = FieldsOf(summary, SampleMetrics());
  EXPECT_TRUE(json.at("diffuse_spread").is_null());
  EXPECT_TRUE(json.at("narrow_lobe").is_null());
  EXPECT_EQ(json.at("roughness_spread"), 0.0);
}

}  // namespace
}  // namespace glint
