#include "calib/light/settle.h"

#include "calib/light/contradictions.h"
#include "calib/light/thinned.h"
#include "calib/light/turned_photos.h"

namespace glint::light {
namespace {

constexpr size_t kSpots = 120;  // of a photo, to decide by

// One solution: turns, contradictions and what the paper insists on follow from it.
bool SettleWith(const LightProblem& problem, const LightOptions& options, State* start,
                State* solved, int* rounds) {
  const auto leave_out = [&] {
    do {
      *solved = *start;
      if (!SolveRobustly(options, solved, rounds)) return false;
    } while (LeaveOutContradiction(options, *solved, start));
    return true;
  };
  if (!leave_out()) return false;
  if (!FreeWhatThePaperInsistsOn(problem, options, start, solved)) return true;
  // What contradicted the others may go with them now.
  bool again = false;
  for (PhotoState& photo : start->photos) {
    again = again || photo.contradicts;
    photo.used = photo.used || photo.contradicts;
    photo.contradicts = false;
  }
  return !again || leave_out();
}

// Turns that neither EXIF nor the picture's size tells of must explain the paper better in the end:
// of a wrong tone curve, flashes seem to wander.
bool SettleAll(const LightProblem& problem, const LightOptions& options, State* start,
               State* solved, int* rounds) {
  State turned = *start;
  const bool unexpected = FindTurns(problem, options, true, &turned);
  FindTurns(problem, options, false, start);
  if (!SettleWith(problem, options, start, solved, rounds)) return false;
  State solved_turned;
  if (unexpected && SettleWith(problem, options, &turned, &solved_turned, rounds) &&
      Insists(options, solved_turned, *solved)) {
    *start = turned;
    *solved = solved_turned;
  }
  return true;
}

}  // namespace

bool Settle(const LightProblem& problem, const LightOptions& options, State* state, int* rounds) {
  State start = Thinned(*state, kSpots), solved;
  if (!SettleAll(problem, options, &start, &solved, rounds)) return false;
  state->hold_tone = start.hold_tone;
  state->flash_along_free = start.flash_along_free;
  for (size_t i = 0; i < state->photos.size(); ++i) {
    PhotoState& photo = state->photos[i];
    photo.contradicts = start.photos[i].contradicts;
    photo.used = photo.used && !photo.contradicts;
    photo.turns = start.photos[i].turns;
    TurnSpots(photo.turns, &photo);
  }
  return DropPhotos(options, state);
}

}  // namespace glint::light
