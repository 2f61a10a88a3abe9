// How long stages take, relative to each other: what `glint run` derives its remaining time from.
//
// Seconds are those of two cores with AVX-512 and bfloat16. On another machine all are off by about
// one factor, which the time that a run has taken so far shows.
#pragma once

#include <string>

#include "pipeline/contract/capture.h"

namespace glint {

struct CaptureSize {
  int photographs = 0;
  double photograph_px = 0;  // of one
  double texels = 0;
};

// Of the capture's photographs, by the first one's header. An imported capture's are as large as
// its maps.
CaptureSize SizeOf(const Capture& capture);

// 0 for a stage that is not among those of `glint run`.
double PredictedSeconds(const std::string& stage, const CaptureSize& size);

}  // namespace glint
