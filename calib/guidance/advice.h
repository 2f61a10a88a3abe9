// The sentences of a verdict. Each has a topic, by which tests and programs know it:
//   over_board  the sample as described reaches over the printed board
//   unseen      part of the sample is in no photograph
//   board       the board looks the same from two sides
//   light       the board's light contradicts EXIF, the encoding or the flash's place
//   focal       the focal length is assumed, or known poorly
//   few         more photographs lower the errors
//   tilted      all photographs look straight down
//   sides       tilted photographs come from one side
//   top         no photograph near the top
//   highlight   part of the sample never shows a highlight
//   clipped     too much of the sample is clipped in some photographs
//   resolution  a texel is smaller than a pixel
//   soft        a sharp photograph's pixel as large as the blur is would be larger than a texel
//   left_out    photographs that are not used
//   cut         photographs that show part of the sample only
#pragma once

#include <string>
#include <vector>

#include "calib/guidance/verdict.h"

namespace glint {

// Of a verdict whose figures are filled; sorted by importance, within it in the order above.
std::vector<Advice> AdviceFor(const GuidanceInput& input, const Verdict& verdict);

// "clipped" and "left_out", which fixed cameras have too (light_advice.h). Nothing is added where
// nothing is to be said; `remedy` ends the sentence.
void AddClipped(const Verdict& verdict, const std::string& remedy, std::vector<Advice>* list);
void AddLeftOut(const GuidanceInput& input, const Verdict& verdict, const std::string& remedy,
                std::vector<Advice>* list);

}  // namespace glint
