// What stages cost, by the capture's size: what `glint estimate` says, what `glint run` derives its
// remaining time from, and what is refused where memory is short.
//
// Seconds are those of two cores of an EPYC with AVX-512; with AVX2 alone they are the same. On
// another machine all are off by about one factor, which the time that a run has taken so far
// shows.
#pragma once

#include <string>

#include "base/formats/capture.h"

namespace glint {

struct CaptureSize {
  int photographs = 0;
  double photograph_px = 0;  // of one; 0: not known, for stages that decode none
  double texels = 0;
  bool native_bfloat16 = false;  // of the processor: networks take half the time
};

// By capture.toml; an imported capture's by its rectified views. Photographs are not looked at:
// what reads them brings in the libraries that decode them (SizeOf, capture_size.h).
CaptureSize SizeOfMaps(const Capture& capture);

// Of a stage, or of "initial": the stage fit with its method of that name, which fits nothing. 0
// for any other.
double PredictedSeconds(const std::string& stage, const CaptureSize& size);

// The most memory that a stage's program holds at once with `threads` threads, bytes; likewise 0.
double PredictedMemory_bytes(const std::string& stage, const CaptureSize& size, int threads);

// Throws EnvironmentError where that is more than MemoryLimit_bytes().
void RequireMemoryForStage(const std::string& stage, const Capture& capture,
                           const CaptureSize& size, int threads);

}  // namespace glint
