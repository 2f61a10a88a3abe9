// How long a capture's stages will take, and how much memory they need.
#pragma once

#include <string>
#include <vector>

#include "base/programs/cost_model.h"
#include "pipeline/driver/stage_graph.h"

namespace glint {

struct StageEstimate {
  StageStep step;
  double seconds = 0, memory_bytes = 0;
};

struct CaptureEstimate {
  CaptureSize size;
  std::vector<StageEstimate> stages;

  double seconds() const;       // of all, one after the other
  double memory_bytes() const;  // of the largest
  std::string ToText() const;
  Json ToJson() const;
};

CaptureEstimate EstimateCapture(const Capture& capture, const std::vector<StageStep>& steps,
                                int threads);

}  // namespace glint
