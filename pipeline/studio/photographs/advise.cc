#include "pipeline/studio/photographs/advise.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace glint {
namespace {

// README: about twelve photographs, four of them within 10° of vertical.
constexpr int kTopViews = 4;
// More change little: docs/results/table1.md ends at 20.
constexpr size_t kMostPhotos = 20;
// Between the highlights of neighbouring top views; within GuidanceLimits' top_deg.
constexpr double kTopTilt_deg = 7;
// The tilts that README asks for, 15 to 40°, in three steps. Where they are equally rare the first
// is asked for: the least also brings highlights to the rim.
constexpr std::array kTilts_deg = {17.5, 35.0, 25.0};

constexpr char kOtherBoard[] = "It shows another board than the capture's";

std::string RemedyFor(RemarkKind kind) {
  switch (kind) {
    case RemarkKind::kBlurred:
      return "Hold the phone still, tap the sample to focus, and take it again.";
    case RemarkKind::kDark:
      return "Check that the flash fires, and take it again.";
    case RemarkKind::kOverexposed:
      return "Step back or expose less, and take it again.";
    case RemarkKind::kDuplicate:
      return "Leave one of the two out, and take one from another side.";
    case RemarkKind::kExif:
      break;
  }
  return "Compare it with the others, and take it again if it differs.";
}

std::string Sentence(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') {
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  }
  if (!text.empty() && text.back() != '.') text += '.';
  return text;
}

std::string InBrief(const Board& board) {
  if (board.squares_x == 0) return fmt::format("has {} markers", board.markers.size());
  return fmt::format("has {} × {} squares", board.squares_x, board.squares_y);
}

// What the check itself says, without the others.
PhotoVerdict JudgeAlone(const PhotoCheck& check, const CheckTask& task) {
  using State = PhotoVerdict::State;
  if (!check.unreadable.empty()) {
    return {State::kBad, "The file cannot be read: " + Sentence(check.unreadable),
            "Send the photograph again.", ""};
  }
  if (!task.board) return {};
  if (check.mismatch) {
    return {State::kBad, fmt::format("{}, which {}.", kOtherBoard, InBrief(*task.board)),
            "Choose the board that lies round the sample.", ""};
  }
  if (!check.board_found) {
    return {State::kBad,
            "The board was not found" +
                (check.board_problem.empty() ? "." : ": " + check.board_problem + "."),
            "Take it again with the whole board in the picture, sharp and lit by the flash.", ""};
  }
  const GuidanceLimits limits;
  if (check.clipped_share > limits.clipped_share) {
    return {State::kWeak,
            fmt::format("{:.0f} % of the sample is clipped.", 100 * check.clipped_share),
            "Step back or expose less.", ""};
  }
  if (!check.pose) {
    return {State::kWeak, "Only part of the board is visible, so its position is unknown.",
            "Take it again with the whole board in the picture.", ""};
  }
  const double shown = ShownShare(*check.pose, MakeCoverageGrid(task.sample_size_mm));
  if (1 - shown > limits.cut_share) {
    return {State::kWeak, fmt::format("It shows only {:.0f} % of the sample.", 100 * shown),
            "Step back until the whole board is in the picture.", ""};
  }
  return {};
}

void AddRemarks(const std::vector<PhotoMeasures>& measures, std::vector<PhotoVerdict>* verdicts,
                const std::vector<size_t>& index) {
  for (const Remark& remark : Triage(measures)) {
    // What EXIF says is a hint to whoever reads a log; here it would make good photographs weak.
    if (remark.kind == RemarkKind::kExif) continue;
    for (size_t i = 0; i < measures.size(); ++i) {
      if (measures[i].name != remark.photo) continue;
      PhotoVerdict& verdict = (*verdicts)[index[i]];
      if (verdict.state == PhotoVerdict::State::kBad) continue;
      verdict.state = remark.condemns ? PhotoVerdict::State::kBad : PhotoVerdict::State::kWeak;
      verdict.reason = Sentence(remark.text);
      verdict.remedy = RemedyFor(remark.kind);
      verdict.same_as = remark.same_as;
    }
  }
}

std::vector<GuidancePhoto> PosesOf(const std::vector<NamedCheck>& photos) {
  std::vector<GuidancePhoto> poses;
  for (const NamedCheck& photo : photos) {
    if (!photo.check.pose) continue;
    poses.push_back(*photo.check.pose);
    poses.back().name = photo.name;
  }
  return poses;
}

bool Has(const Verdict& verdict, const std::string& topic) {
  return std::any_of(verdict.advice.begin(), verdict.advice.end(),
                     [&](const Advice& one) { return one.topic == topic; });
}

// Round the sample where there is none yet, at the tilt that is rarest.
Direction NextTilted(const Verdict& verdict, const std::vector<GuidancePhoto>& photos) {
  std::array<int, kTilts_deg.size()> count{};
  for (const ViewFacts& view : verdict.views) {
    if (view.camera.tilt_deg < verdict.limits.tilted_deg) continue;
    size_t nearest = 0;
    for (size_t i = 1; i < kTilts_deg.size(); ++i) {
      if (std::abs(view.camera.tilt_deg - kTilts_deg[i]) <
          std::abs(view.camera.tilt_deg - kTilts_deg[nearest])) {
        nearest = i;
      }
    }
    ++count[nearest];
  }
  const auto rarest = std::min_element(count.begin(), count.end()) - count.begin();
  return {kTilts_deg[static_cast<size_t>(rarest)],
          LargestGap(photos, verdict.limits.tilted_deg).middle_deg};
}

// Where it brings most highlights; where none is lacking, beside the others.
Direction NextTop(const Verdict& verdict, const std::vector<GuidancePhoto>& photos) {
  if (verdict.top_views == 0) return {0, 0};
  if (!verdict.suggestions.empty()) return verdict.suggestions[0].direction;
  constexpr double kOffCentre_deg = 3;
  std::vector<GuidancePhoto> tops;
  for (const GuidancePhoto& photo : photos) {
    if (DirectionOf(photo.camera_in_sample_mm).tilt_deg <= verdict.limits.top_deg) {
      tops.push_back(photo);
    }
  }
  return {kTopTilt_deg, LargestGap(tops, kOffCentre_deg).middle_deg};
}

bool ShowsHighlights(const Verdict& verdict, const Direction& direction) {
  if (!Has(verdict, "highlight") || verdict.suggestions.empty()) return false;
  const Direction& best = verdict.suggestions[0].direction;
  return best.tilt_deg == direction.tilt_deg && best.azimuth_deg == direction.azimuth_deg;
}

// Why the photograph is asked for, in a few words.
std::string Reason(const Verdict& verdict, const Direction& direction) {
  if (verdict.top_views == 0) return "the fit is initialised from such a view";
  if (verdict.tilted_views == 0) return "tilted views reveal relief and gloss";
  if (ShowsHighlights(verdict, direction)) return "it shows a highlight where none has been seen";
  if (direction.tilt_deg <= verdict.limits.top_deg) {
    return "a few views from near the top make the colours more certain";
  }
  if (Has(verdict, "sides")) return "no tilted photograph comes from there yet";
  return "each further side lowers the error";
}

// While no photograph is used.
StudioAdvice AdviseFirst(const std::vector<LeftOutPhoto>& left_out) {
  const bool all_show_another =
      !left_out.empty() &&
      std::all_of(left_out.begin(), left_out.end(),
                  [](const LeftOutPhoto& photo) { return photo.reason.starts_with(kOtherBoard); });
  StudioAdvice advice;
  if (all_show_another) {
    advice.sentence =
        "Every photograph shows another board than the capture's: choose the board that lies round "
        "the sample.";
    return advice;
  }
  advice.sentence =
      "Take the first photograph straight from above, flash on, the whole board in the picture.";
  advice.target = Direction{0, 0};
  return advice;
}

StudioAdvice AdviseWithoutBoard(const Capture& capture, const std::vector<NamedCheck>& used) {
  StudioAdvice advice;
  if (capture.fixed_camera() || capture.imported()) {
    advice.verdict = used.empty() && !capture.imported() ? "none" : "usable";
    advice.enough = true;
    advice.sentence = "Studio gives no advice for captures of this kind; run it.";
    return advice;
  }
  if (used.empty()) {
    advice.sentence =
        "Take one photograph straight from above, with the flash on and the room dark.";
    advice.target = Direction{0, 0};
    return advice;
  }
  advice.verdict = "usable";
  advice.enough = true;
  advice.sentence =
      "There is one photograph: run it. Several with a board give more accurate maps.";
  return advice;
}

}  // namespace

std::string_view StateName(PhotoVerdict::State state) {
  switch (state) {
    case PhotoVerdict::State::kGood:
      return "good";
    case PhotoVerdict::State::kWeak:
      return "weak";
    case PhotoVerdict::State::kBad:
      break;
  }
  return "bad";
}

std::vector<PhotoVerdict> JudgePhotos(const std::vector<NamedCheck>& photos,
                                      const CheckTask& task) {
  std::vector<PhotoVerdict> verdicts;
  std::vector<PhotoMeasures> measures;
  std::vector<size_t> index;
  for (size_t i = 0; i < photos.size(); ++i) {
    verdicts.push_back(JudgeAlone(photos[i].check, task));
    if (!photos[i].check.unreadable.empty()) continue;
    measures.push_back(photos[i].check.measures);
    measures.back().name = photos[i].name;
    index.push_back(i);
  }
  AddRemarks(measures, &verdicts, index);
  return verdicts;
}

Direction NextDirection(const Verdict& verdict, const std::vector<GuidancePhoto>& photos) {
  if (photos.empty() || verdict.top_views == 0) return {0, 0};
  if (verdict.tilted_views == 0) return NextTilted(verdict, photos);
  const bool dark = Has(verdict, "highlight") && !verdict.suggestions.empty();
  const bool one_sided = Has(verdict, "sides");
  // In turn, so that neither is left for the end: highlights tell roughness, sides tell relief.
  const bool few_are_tilted = 2 * verdict.tilted_views < static_cast<int>(verdict.views.size());
  if (dark && !few_are_tilted) return verdict.suggestions[0].direction;
  if (dark || one_sided) return NextTilted(verdict, photos);
  // One top view for each two tilted ones, as in README's twelve.
  if (verdict.top_views < kTopViews && 2 * verdict.top_views < verdict.tilted_views + 1) {
    return NextTop(verdict, photos);
  }
  return NextTilted(verdict, photos);
}

StudioAdvice AdviseFor(const Capture& capture, const std::vector<NamedCheck>& used,
                       const std::vector<LeftOutPhoto>& left_out) {
  if (!capture.has_board || capture.fixed_camera()) return AdviseWithoutBoard(capture, used);
  const std::vector<GuidancePhoto> poses = PosesOf(used);
  StudioAdvice advice;
  if (poses.empty()) return AdviseFirst(left_out);
  GuidanceInput input;
  input.sample_size_mm = capture.sample_size_mm;
  input.resolution_px = capture.resolution_px;
  input.photos = poses;
  input.left_out = left_out;
  Verdict verdict = Judge(input);
  if (verdict.tilted_views == 0) {  // the calibration could not tell the focal length
    input.focal_assumed = true;
    verdict = Judge(input);
  }
  const std::string word = verdict.Word();
  advice.verdict = word == "not enough" ? "poor" : word;
  for (const Advice& one : verdict.advice) advice.list.push_back(Sentence(one.text));
  const size_t wanted = static_cast<size_t>(verdict.limits.enough_photos);
  const bool lacks_views = Has(verdict, "unseen") || Has(verdict, "tilted") ||
                           Has(verdict, "sides") || Has(verdict, "top") ||
                           Has(verdict, "highlight");
  advice.enough = poses.size() >= kMostPhotos || (poses.size() >= wanted && !lacks_views);
  if (advice.enough) {
    advice.sentence = "That is enough: run it, or look at what can still be better.";
    return advice;
  }
  if (Has(verdict, "over_board")) {
    advice.sentence = advice.list[0];
    return advice;
  }
  advice.target = NextDirection(verdict, poses);
  advice.sentence = fmt::format("Take the next one {}, looking at the sample's middle: {}.",
                                InWords(*advice.target), Reason(verdict, *advice.target));
  return advice;
}

}  // namespace glint
