#include "calib/registration/predicted_shifts.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/model/registration.h"
#include "base/model/solver.h"
#include "base/parallel/parallel.h"
#include "calib/registration/factor_analysis.h"
#include "calib/registration/window_textures.h"

namespace glint {
namespace {

// Derivatives by column and row of a window's picture; 0 at its rim, where a Hann window is.
struct Gradient {
  Eigen::RowVectorXf by_column, by_row;
};
Gradient GradientOf(const Eigen::RowVectorXf& values, int width) {
  Gradient gradient{Eigen::RowVectorXf::Zero(values.size()),
                    Eigen::RowVectorXf::Zero(values.size())};
  for (int y = 1; y + 1 < width; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const int i = y * width + x;
      gradient.by_column[i] = 0.5f * (values[i + 1] - values[i - 1]);
      gradient.by_row[i] = 0.5f * (values[i + width] - values[i - width]);
    }
  }
  return gradient;
}

class Window {
 public:
  Window(const DetailPictures& pictures, const SamplePlaces& places, const cv::Size& size,
         const cv::Rect& rect)
      : rect_(rect),
        pixel_mm_(pictures.PixelSide_mm(size)),
        centre_mm_(
            pictures.SamplePoint(size, rect.x + 0.5 * rect.width, rect.y + 0.5 * rect.height)),
        textures_(TexturesOf(pictures, places, size, rect)) {
    const FactorModel model = FitFactors(textures_.Covariance(), FactorsOf(pictures.views()));
    precision_ = model.covariance.ldlt().solve(
        Eigen::MatrixXd::Identity(pictures.views(), pictures.views()));
  }

  // False where the others say nothing of this view's texture.
  bool Shift(int view, PredictedShift* found) const {
    Eigen::RowVectorXf weights = -(precision_.row(view) / precision_(view, view)).cast<float>();
    weights[view] = 0;
    const Eigen::RowVectorXf predicted = weights * textures_.values;
    const Eigen::RowVectorXf left = textures_.values.row(view) - predicted;
    const Gradient gradient = GradientOf(predicted, rect_.width);
    const Eigen::RowVectorXf column = gradient.by_column.cwiseProduct(textures_.weight);
    const Eigen::RowVectorXf row = gradient.by_row.cwiseProduct(textures_.weight);
    Eigen::Matrix2d normal;
    normal(0, 0) = column.dot(gradient.by_column);
    normal(1, 1) = row.dot(gradient.by_row);
    normal(0, 1) = normal(1, 0) = column.dot(gradient.by_row);
    const double of_diagonal = normal(0, 0) * normal(1, 1);
    if (!(normal.determinant() > constants::kLeastGradient * of_diagonal)) return false;
    const Eigen::Vector2d right(column.dot(left), row.dot(left));
    // predicted(p + step) = seen(p): this view shows at p what the others have at p + step.
    const Eigen::Vector2d step = normal.ldlt().solve(right);
    if (!(step.norm() < constants::kLongestStep_px)) return false;
    found->view = view;
    found->point_mm = centre_mm_;
    found->shift_mm = pixel_mm_ * Eigen::Vector2d(-step.x(), step.y());
    normal(0, 1) = normal(1, 0) = -normal(0, 1);  // rows run downward
    found->information = normal * precision_(view, view) / (pixel_mm_ * pixel_mm_);
    return true;
  }

 private:
  cv::Rect rect_;
  double pixel_mm_;
  Eigen::Vector2d centre_mm_;
  WindowTextures textures_;
  Eigen::MatrixXd precision_;
};

}  // namespace

std::vector<PredictedShift> PredictedShifts(const DetailPictures& pictures,
                                            const SamplePlaces& places, const cv::Size& size,
                                            int threads) {
  if (FactorsOf(pictures.views()) == 0) return {};
  const int width = 2 * static_cast<int>(std::lround(0.5 * constants::kTextureWindow *
                                                     std::max(size.width, size.height)));
  const std::vector<cv::Rect> rects = WindowsOf(pictures, size, width, width / 2);
  std::vector<std::vector<PredictedShift>> by_window(rects.size());
  ForEachPiece(static_cast<int>(rects.size()), threads, [&](int piece) {
    const auto i = static_cast<size_t>(piece);
    const Window window(pictures, places, size, rects[i]);
    for (int view = 0; view < pictures.views(); ++view) {
      PredictedShift shift;
      if (window.Shift(view, &shift)) by_window[i].push_back(shift);
    }
  });
  std::vector<PredictedShift> all;
  for (const auto& shifts : by_window) all.insert(all.end(), shifts.begin(), shifts.end());
  return all;
}

}  // namespace glint
