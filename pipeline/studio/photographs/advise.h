// From checked photographs to what the photographer should do next.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/guidance/verdict.h"
#include "calib/triage/triage.h"
#include "pipeline/studio/photographs/photo_check.h"

namespace glint {

// How good one photograph is among the others.
struct PhotoVerdict {
  enum class State { kGood, kWeak, kBad } state = State::kGood;
  std::string reason, remedy;  // of a weak or bad one
  std::string same_as;         // name of the photograph that it repeats; empty: none
};

struct NamedCheck {
  std::string name;
  PhotoCheck check;
};

// In the photographs' order. A bad one does more harm than good.
std::vector<PhotoVerdict> JudgePhotos(const std::vector<NamedCheck>& photos, const CheckTask& task);

struct StudioAdvice {
  std::string verdict = "none";     // "good", "usable", "poor"; "none": no photograph is used
  std::string sentence;             // what to do now
  std::optional<Direction> target;  // where the next photograph is to be taken from; none: anywhere
  bool enough = false;
  std::vector<std::string> list;  // everything that can be said, most important first
};

// Of the photographs that are used. A capture without a board has no directions to go by.
StudioAdvice AdviseFor(const Capture& capture, const std::vector<NamedCheck>& used,
                       const std::vector<LeftOutPhoto>& left_out);

// Where a photograph brings most. `photos` may be empty: straight from above.
Direction NextDirection(const Verdict& verdict, const std::vector<GuidancePhoto>& photos);

std::string_view StateName(PhotoVerdict::State state);

}  // namespace glint
