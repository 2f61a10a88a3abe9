#include "calib/registration/sample_moves.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "base/model/registration.h"
#include "base/model/solver.h"
#include "calib/registration/common_motion.h"
#include "calib/registration/common_texture.h"
#include "calib/registration/factor_analysis.h"

namespace glint {
namespace {

using Eigen::Rotation2Dd;
using Eigen::Vector2d;

double Longest_mm(const RegistrationProblem& problem) {
  return std::max(problem.sample_width_mm, problem.sample_height_mm);
}

// That takes a moved sample back.
HomographyValues HomographyOf(const SampleMove& move, double unit_mm) {
  const double cosine = std::cos(move.turn_rad), sine = std::sin(move.turn_rad);
  const Vector2d back = -(Rotation2Dd(-move.turn_rad) * move.shift_mm) / unit_mm;
  return {cosine - 1, sine, back.x(), -sine, cosine - 1, back.y(), 0, 0};
}

class Mover {
 public:
  Mover(const RegistrationProblem& problem, const DetailPictures& pictures,
        const PlaneValues& plane)
      : pictures_(pictures),
        size_(pictures.SizeOf(constants::kMovesSide_px)),
        longest_mm_(Longest_mm(problem)),
        moves_(problem.views.size()),
        explained_(problem.views.size(), 0.0),
        group_(problem.views.size(), -1) {
    places_.unit_mm = 0.5 * longest_mm_;
    places_.homographies.resize(problem.views.size());
    places_.plane = plane;
    cv::createHanningWindow(taper_, size_, CV_32F);
    for (int view = 0; view < pictures.views(); ++view) details_.push_back(Seen(view, {}));
  }

  SampleMoves Find() {
    std::vector<std::vector<int>> groups;
    // Of a sample without texture every view would be a group.
    while (std::ssize(groups) < constants::kMostTextures) {
      std::vector<int> views = Grow();
      if (views.empty()) break;
      for (const int view : views) group_[Index(view)] = static_cast<int>(groups.size());
      groups.push_back(std::move(views));
    }
    if (groups.empty()) return {};
    std::stable_sort(groups.begin(), groups.end(),
                     [](const auto& a, const auto& b) { return a.size() > b.size(); });
    TakeIn(&groups);
    const std::vector<int>& most = groups[0];
    SampleMoves found;
    if (most.size() > 2 && (groups.size() > 1 || SeemsMoved(most))) {
      for (int sweep = 0; sweep < constants::kMoveSweeps; ++sweep) {
        for (const std::vector<int>& views : groups) PlaceAgain(views);
      }
      found.textures = Textures(groups);
      if (SeemsMoved(most)) found.moves = Moved(most);
    }
    return found;
  }

 private:
  static size_t Index(int view) { return static_cast<size_t>(view); }

  int Reach_px() const {
    return static_cast<int>(constants::kLongestMove * std::max(size_.width, size_.height));
  }

  // The middle of the sample as the view shows it had it been moved like that.
  cv::Mat Seen(int view, const SampleMove& move) {
    places_.homographies[Index(view)] = HomographyOf(move, places_.unit_mm);
    cv::Mat detail = pictures_.LookUp(view, places_, size_).mul(taper_);
    if (const double norm = cv::norm(detail); norm > 0) detail /= norm;
    return detail;
  }

  // How views of a level surface are told apart: by where their cameras are.
  Vector2d Direction(int view) const {
    const Eigen::Vector3d& camera_mm = pictures_.camera_mm(view);
    return camera_mm.head<2>() / camera_mm.z();
  }

  // Of the others, those whose light is likest.
  std::vector<int> Nearest(int view, std::vector<int> others) const {
    std::erase(others, view);
    std::stable_sort(others.begin(), others.end(), [&](int a, int b) {
      return (Direction(a) - Direction(view)).norm() < (Direction(b) - Direction(view)).norm();
    });
    if (std::ssize(others) > constants::kAllPairsUpTo) others.resize(constants::kAllPairsUpTo);
    return others;
  }

  CommonTexture TextureOf(int view, const std::vector<int>& others) const {
    std::vector<cv::Mat> pictures;
    for (const int other : Nearest(view, others)) pictures.push_back(details_[Index(other)]);
    return {pictures, Reach_px()};
  }

  // Of the turns about none, a step each way where so much is explained without.
  std::pair<double, TextureShift> BestTurn(int view, const CommonTexture& texture,
                                           double explained) {
    const int each_way = explained < constants::kWellExplained ? constants::kTurnsEachWay : 1;
    std::pair<double, TextureShift> best;
    for (int turn = -each_way; turn <= each_way; ++turn) {
      if (turn == 0) continue;
      const double turn_rad = turn * constants::kTurnStep_rad;
      const TextureShift shift = texture.Compare(Seen(view, {turn_rad, {0, 0}}));
      if (shift.explained > best.second.explained) best = {turn_rad, shift};
    }
    return best;
  }

  // Moves the view to where the others explain it best. Whether they do at all.
  bool Place(int view, const std::vector<int>& others, bool search_turns) {
    const CommonTexture texture = TextureOf(view, others);
    SampleMove from = moves_[Index(view)];
    TextureShift shift = texture.Compare(details_[Index(view)]);
    if (search_turns) {
      const auto [turn_rad, turned] = BestTurn(view, texture, shift.explained);
      if (1 - turned.explained < constants::kMoveExplains * (1 - shift.explained)) {
        shift = turned;
        from = {turn_rad, {0, 0}};
      }
    }
    explained_[Index(view)] = shift.explained;
    if (shift.explained < constants::kLeastExplained) return false;
    from.shift_mm +=
        Rotation2Dd(from.turn_rad) *
        (pictures_.PixelSide_mm(size_) * Vector2d(shift.shift_px.x(), -shift.shift_px.y()));
    moves_[Index(view)] = from;
    details_[Index(view)] = Seen(view, from);
    return true;
  }

  // Views without a group that have a texture in common with the first of them.
  std::vector<int> Grow() {
    std::vector<int> left, in;
    for (int view = 0; view < pictures_.views(); ++view) {
      if (group_[Index(view)] < 0 && cv::norm(details_[Index(view)]) > 0) left.push_back(view);
    }
    std::vector<double> apart(moves_.size());
    for (const int view : left) apart[Index(view)] = Direction(view).norm();
    int failed = 0;
    while (!left.empty()) {
      const auto next = std::min_element(left.begin(), left.end(), [&](int a, int b) {
        return apart[Index(a)] < apart[Index(b)];
      });
      const int view = *next;
      left.erase(next);
      if (!in.empty() && !Place(view, in, failed < constants::kTurnSearches)) {
        ++failed;
        continue;
      }
      if (in.size() == 1) explained_[Index(in[0])] = explained_[Index(view)];  // of a pair, alike
      for (const int other : left) {
        const double distance = (Direction(other) - Direction(view)).norm();
        apart[Index(other)] = in.empty() ? distance : std::min(apart[Index(other)], distance);
      }
      in.push_back(view);
    }
    return in;
  }

  // Views that are explained by all of the largest group, if not by its first ones.
  void TakeIn(std::vector<std::vector<int>>* groups) {
    std::vector<int>& most = (*groups)[0];
    for (size_t group = 1; group < groups->size(); ++group) {
      std::vector<int> others;
      for (const int view : (*groups)[group]) {
        const bool same = Place(view, most, true);
        // Of a highlight nearly all over it, neither its place nor another sample can be told.
        if (!same && ShowsPartOf(view, most)) continue;
        (same ? most : others).push_back(view);
      }
      (*groups)[group] = std::move(others);
    }
    std::erase_if(*groups, [](const std::vector<int>& views) { return views.empty(); });
  }

  // Whether any part of the view is explained, beside a highlight.
  bool ShowsPartOf(int view, const std::vector<int>& others) {
    const int side = std::min(size_.width, size_.height) / constants::kPartsOfTexture;
    const auto part = [&](int of, const cv::Rect& window) {
      cv::Mat taper, detail;
      cv::createHanningWindow(taper, window.size(), CV_32F);
      places_.homographies[Index(of)] = HomographyOf(moves_[Index(of)], places_.unit_mm);
      detail = pictures_.LookUp(of, places_, size_, window).mul(taper);
      if (const double norm = cv::norm(detail); norm > 0) detail /= norm;
      return detail;
    };
    for (int y = 0; y + side <= size_.height; y += side) {
      for (int x = 0; x + side <= size_.width; x += side) {
        const cv::Rect window(x, y, side, side);
        std::vector<cv::Mat> pictures;
        for (const int other : Nearest(view, others)) pictures.push_back(part(other, window));
        const TextureShift shift = CommonTexture(pictures, side / 4).Compare(part(view, window));
        if (shift.explained >= constants::kCertainTexture) return true;
      }
    }
    return false;
  }

  void PlaceAgain(const std::vector<int>& views) {
    if (views.size() < 2) return;
    for (const int view : views) Place(view, views, false);
  }

  // What is left unexplained moves the place at which a texture is explained best.
  double Sd_mm(int view) const {
    const double explained = std::max(explained_[Index(view)], constants::kLeastExplained);
    return constants::kFeignedMove * longest_mm_ *
           std::max(constants::kLeastFeigned, (1 - explained) / explained);
  }

  std::vector<ViewShift> Shifts(const std::vector<int>& views) const {
    std::vector<ViewShift> shifts;
    shifts.reserve(views.size());
    for (const int view : views) {
      shifts.push_back({moves_[Index(view)].shift_mm, -Direction(view), Sd_mm(view)});
    }
    return shifts;
  }

  // That of most views, each counted by how near it is to where most of them are.
  double CommonTurn(const std::vector<int>& views, const std::vector<ViewShift>& shifts,
                    const CommonMotion& common) const {
    double most = 0, turn_rad = 0;
    for (const int view : views) {
      const double candidate = moves_[Index(view)].turn_rad;
      double weight = 0;
      for (size_t i = 0; i < views.size(); ++i) {
        if (moves_[Index(views[i])].turn_rad != candidate) continue;
        weight += 1 / (1 + common.Off_mm(shifts[i]).squaredNorm() / std::pow(shifts[i].sd_mm, 2));
      }
      if (weight <= most) continue;
      most = weight;
      turn_rad = candidate;
    }
    return turn_rad;
  }

  // By view of the group: against where most of it is.
  std::vector<SampleMove> Off(const std::vector<int>& views) const {
    const std::vector<ViewShift> shifts = Shifts(views);
    const CommonMotion common = FindCommonMotion(shifts, constants::kFeignedHeight * longest_mm_);
    const double common_turn = CommonTurn(views, shifts, common);
    std::vector<SampleMove> off;
    for (size_t i = 0; i < views.size(); ++i) {
      const double turn = moves_[Index(views[i])].turn_rad - common_turn;
      const Vector2d turned = Rotation2Dd(turn) * common.offset_mm - common.offset_mm;
      off.push_back({turn, common.Off_mm(shifts[i]) - turned});
    }
    return off;
  }

  // What relief feigns, high as it is or lit from elsewhere, is no motion.
  bool SeemsMoved(int view, const SampleMove& off) const {
    const double least_mm =
        std::max(constants::kMove_sd * Sd_mm(view), constants::kLeastMove * longest_mm_);
    return off.turn_rad != 0 || off.shift_mm.norm() > least_mm;
  }

  bool SeemsMoved(const std::vector<int>& views) const {
    const std::vector<SampleMove> off = Off(views);
    for (size_t i = 0; i < views.size(); ++i) {
      if (SeemsMoved(views[i], off[i])) return true;
    }
    return false;
  }

  // Whether the view is explained so much worse where it would be had it not been moved.
  bool Needs(int view, const std::vector<int>& views, const SampleMove& off) {
    SampleMove without = moves_[Index(view)];
    without.turn_rad -= off.turn_rad;
    without.shift_mm -= off.shift_mm;
    const double explained = TextureOf(view, views).Explained(Seen(view, without));
    return 1 - explained_[Index(view)] < constants::kMoveExplains * (1 - explained);
  }

  std::vector<SampleMove> Moved(const std::vector<int>& views) {
    const std::vector<SampleMove> off = Off(views);
    std::vector<SampleMove> moves(moves_.size());
    bool any = false;
    for (size_t i = 0; i < views.size(); ++i) {
      const int view = views[i];
      if (!SeemsMoved(view, off[i]) || !Needs(view, views, off[i])) continue;
      moves[Index(view)] = off[i];
      any = true;
    }
    return any ? moves : std::vector<SampleMove>{};
  }

  // Only of groups that explain their views well is it certain that others have nothing of them.
  std::vector<int> Textures(const std::vector<std::vector<int>>& groups) const {
    std::vector<int> textures(moves_.size(), -1);
    bool several = false;
    for (size_t group = 0; group < groups.size(); ++group) {
      const std::vector<int>& views = groups[group];
      const bool alone = group > 0 && views.size() == 1 && 2 * groups[0].size() > moves_.size();
      const bool certain = alone || std::all_of(views.begin(), views.end(), [&](int view) {
                             return explained_[Index(view)] >= constants::kCertainTexture;
                           });
      if (group == 0 && !certain) return {};
      if (!certain) continue;
      several = several || group > 0;
      for (const int view : views) textures[Index(view)] = group > 0;
    }
    return several ? textures : std::vector<int>{};
  }

  const DetailPictures& pictures_;
  cv::Size size_;
  double longest_mm_;
  SamplePlaces places_;
  cv::Mat taper_;
  // By view.
  std::vector<cv::Mat> details_;  // at its move
  std::vector<SampleMove> moves_;
  std::vector<double> explained_;
  std::vector<int> group_;
};

cv::Mat Moved(const RegistrationProblem& problem, const TopView& view, const SampleMove& move) {
  const cv::Mat radiance(view.height, view.width, CV_32F, const_cast<float*>(view.radiance.data()));
  // Pixel centres at whole numbers; rows from +y on.
  const double across_mm = problem.margin * problem.sample_width_mm / view.width;
  const double down_mm = problem.margin * problem.sample_height_mm / view.height;
  Eigen::Matrix3d place_from_pixel, moved = Eigen::Matrix3d::Identity();
  place_from_pixel << across_mm, 0, (0.5 - 0.5 * view.width) * across_mm, 0, -down_mm,
      (0.5 * view.height - 0.5) * down_mm, 0, 0, 1;
  moved.topLeftCorner<2, 2>() = Rotation2Dd(move.turn_rad).toRotationMatrix();
  moved.topRightCorner<2, 1>() = move.shift_mm;
  const Eigen::Matrix3d look_up = place_from_pixel.inverse() * moved * place_from_pixel;
  const cv::Matx23d map(look_up(0, 0), look_up(0, 1), look_up(0, 2), look_up(1, 0), look_up(1, 1),
                        look_up(1, 2));
  cv::Mat found;
  cv::warpAffine(radiance, found, map, radiance.size(), cv::INTER_CUBIC | cv::WARP_INVERSE_MAP,
                 cv::BORDER_REPLICATE);
  return cv::max(found, 0);
}

}  // namespace

SampleMoves FindMoves(const RegistrationProblem& problem, const DetailPictures& pictures,
                      const PlaneValues& plane) {
  if (FactorsOf(pictures.views()) == 0) return {};
  return Mover(problem, pictures, plane).Find();
}

std::vector<std::vector<size_t>> MovedTogether(const RegistrationProblem& problem,
                                               const std::vector<SampleMove>& moves) {
  const double alike_mm = constants::kLeastMove * Longest_mm(problem);
  const double alike_rad = 2 * constants::kLeastMove;  // at the sample's edge the same
  std::vector<std::vector<size_t>> together(moves.size());
  for (size_t i = 0; i < moves.size(); ++i) {
    for (size_t j = 0; j < moves.size(); ++j) {
      const bool alike = moves[i].none() == moves[j].none() &&
                         std::abs(moves[i].turn_rad - moves[j].turn_rad) <= alike_rad &&
                         (moves[i].shift_mm - moves[j].shift_mm).norm() <= alike_mm;
      if (alike) together[i].push_back(j);
    }
  }
  return together;
}

RegistrationProblem WithoutMoves(RegistrationProblem problem,
                                 const std::vector<SampleMove>& moves) {
  for (size_t i = 0; i < moves.size(); ++i) {
    if (moves[i].none()) continue;
    TopView& view = problem.views[i];
    const cv::Mat moved = Moved(problem, view, moves[i]);
    view.radiance.assign(moved.ptr<float>(), moved.ptr<float>() + moved.total());
    view.camera_mm = Inverse(moves[i].Motion()) * view.camera_mm;
  }
  return problem;
}

}  // namespace glint
