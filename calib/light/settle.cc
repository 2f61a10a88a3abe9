#include "calib/light/settle.h"

#include <utility>

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

// Samples read with gamma 2.2, by sRGB's curve.
void ReadAsSrgb(State* state) {
  state->srgb = true;
  for (PhotoState& photo : state->photos) {
    for (Spot& spot : photo.spots) spot.seen = spot.seen.unaryExpr(&SrgbForGamma22);
  }
}

struct Settled {
  State start, solved;
  bool known = false;

  int freedoms() const { return !start.hold_tone + start.flash_along_free; }
};

Settled SettleFrom(const LightProblem& problem, const LightOptions& options, const State& state,
                   int* rounds) {
  Settled settled;
  settled.start = Thinned(state, kSpots);
  settled.known = SettleAll(problem, options, &settled.start, &settled.solved, rounds);
  return settled;
}

// A curve that needs nothing else to explain the paper is preferred to one that does.
bool IsSrgb(const LightOptions& options, const Settled& gamma, const Settled& srgb) {
  if (!srgb.known || !gamma.known) return srgb.known;
  if (srgb.freedoms() > gamma.freedoms()) return Insists(options, srgb.solved, gamma.solved);
  return srgb.freedoms() < gamma.freedoms() ? !Insists(options, gamma.solved, srgb.solved)
                                            : Prefers(options, srgb.solved, gamma.solved);
}

}  // namespace

bool Settle(const LightProblem& problem, const LightOptions& options, State* state, int* rounds) {
  Settled settled = SettleFrom(problem, options, *state, rounds);
  if (options.perhaps_srgb) {
    State read = *state;
    ReadAsSrgb(&read);
    Settled srgb = SettleFrom(problem, options, read, rounds);
    if (IsSrgb(options, settled, srgb)) {
      settled = std::move(srgb);
      *state = std::move(read);
    }
  }
  if (!settled.known) return false;
  const State& start = settled.start;
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
