#include "training/capture_numbers.h"

#include <algorithm>
#include <array>

#include "fitting/layers/staging.h"

namespace glint {
namespace {

using torch::Tensor;
using D = Disturbance;

constexpr std::array kOfDisturbance{&D::plane_height, &D::plane_slope_x, &D::plane_slope_y,
                                    &D::relief,       &D::shadow,        &D::blur,
                                    &D::noise,        &D::gamma,         &D::toe,
                                    &D::jpeg_quality, &D::second_lobe,   &D::second_lobe_width,
                                    &D::gain,         &D::gain_period,   &D::gain_phase};
constexpr std::array kOfShot{&Shot::shift_x,    &Shot::shift_y,    &Shot::gradient_x,
                             &Shot::gradient_y, &Shot::vignetting, &Shot::frame_x,
                             &Shot::frame_y,    &Shot::frame_end};
constexpr std::array kOfCapture{&DrawnCapture::ldr, &DrawnCapture::calibrated,
                                &DrawnCapture::power_guessed, &DrawnCapture::rare_if_metal,
                                &DrawnCapture::rare_if_not};
constexpr size_t kColumns = kOfDisturbance.size() + kOfShot.size() + kOfCapture.size();

template <class Fields, class Field>
size_t Place(const Fields& fields, Field field) {
  const auto found = std::find(fields.begin(), fields.end(), field);
  TORCH_CHECK(found != fields.end(), "capture numbers: a field that is not copied to the device");
  return static_cast<size_t>(found - fields.begin());
}

}  // namespace

CaptureNumbers::CaptureNumbers(const std::vector<DrawnCapture>& captures,
                               const torch::TensorOptions& options) {
  std::vector<double> values;
  for (const DrawnCapture& capture : captures) {
    for (const Shot& shot : capture.shots) {
      for (const auto field : kOfDisturbance) values.push_back(capture.disturbance.*field);
      for (const auto field : kOfShot) values.push_back(shot.*field);
      for (const auto field : kOfCapture) values.push_back(capture.*field);
    }
  }
  const auto count = static_cast<int64_t>(captures.size());
  const auto shots = static_cast<int64_t>(captures.at(0).shots.size());
  all_ = Staged(values, {count, shots, static_cast<int64_t>(kColumns), 1, 1}, options);
}

Tensor CaptureNumbers::Column(size_t k) const {
  const auto column = static_cast<int64_t>(k);
  return all_.slice(2, column, column + 1);
}

Tensor CaptureNumbers::operator()(double Disturbance::*field) const {
  return Column(Place(kOfDisturbance, field));
}

Tensor CaptureNumbers::operator()(double Shot::*field) const {
  return Column(kOfDisturbance.size() + Place(kOfShot, field));
}

Tensor CaptureNumbers::operator()(double DrawnCapture::*field) const {
  return Column(kOfDisturbance.size() + kOfShot.size() + Place(kOfCapture, field));
}

CaptureSubset::CaptureSubset(const std::vector<DrawnCapture>& captures,
                             const torch::TensorOptions& options,
                             const std::function<bool(const DrawnCapture&)>& is_in) {
  std::vector<double> values;
  for (size_t b = 0; b < captures.size(); ++b) {
    if (!is_in(captures[b])) continue;
    numbers.push_back(b);
    values.push_back(static_cast<double>(b));
  }
  index = Staged(values, {static_cast<int64_t>(values.size())}, options.dtype(torch::kInt64));
}

Tensor CaptureSubset::Of(const Tensor& of_captures) const {
  return of_captures.index_select(0, index);
}

Tensor CaptureSubset::Replaced(const Tensor& of_captures, const Tensor& rows) const {
  return of_captures.index_copy(0, index, rows);
}

}  // namespace glint
