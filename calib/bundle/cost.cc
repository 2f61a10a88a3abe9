#include "calib/bundle/cost.h"

#include <ceres/jet.h>

#include <array>

namespace glint::bundle {
namespace {

// One width of derivatives for every model: a single instance of the model's code, which costs less
// to compile than the unused derivatives cost to carry.
class ReprojectionCost : public ceres::CostFunction {
 public:
  ReprojectionCost(const ReprojectionError& error, int camera_parameters, bool bend_is_free)
      : error_(error), camera_parameters_(camera_parameters), bend_is_free_(bend_is_free) {
    set_num_residuals(2);
    *mutable_parameter_block_sizes() = {camera_parameters, kPose};
    if (bend_is_free) mutable_parameter_block_sizes()->push_back(kBend);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    if (jacobians == nullptr) {
      return bend_is_free_ ? error_(parameters[0], parameters[1], parameters[2], residuals)
                           : error_(parameters[0], parameters[1], residuals);
    }
    std::array<Jet, kMostCamera> camera;
    std::array<Jet, kPose> pose;
    std::array<Jet, kBend> bend;
    Fill(parameters[0], camera_parameters_, 0, camera.data());
    Fill(parameters[1], kPose, kMostCamera, pose.data());
    if (bend_is_free_) Fill(parameters[2], kBend, kMostCamera + kPose, bend.data());
    Jet out[2];
    const bool good = bend_is_free_ ? error_(camera.data(), pose.data(), bend.data(), out)
                                    : error_(camera.data(), pose.data(), out);
    if (!good) return false;
    residuals[0] = out[0].a;
    residuals[1] = out[1].a;
    Read(out, camera_parameters_, 0, jacobians[0]);
    Read(out, kPose, kMostCamera, jacobians[1]);
    if (bend_is_free_) Read(out, kBend, kMostCamera + kPose, jacobians[2]);
    return true;
  }

 private:
  static constexpr int kMostCamera = kMostCameraParameters, kPose = 6, kBend = 2;
  using Jet = ceres::Jet<double, kMostCamera + kPose + kBend>;

  static void Fill(const double* values, int count, int first, Jet* jets) {
    for (int i = 0; i < count; ++i) jets[i] = Jet(values[i], first + i);
  }
  static void Read(const Jet* residuals, int count, int first, double* jacobian) {
    if (jacobian == nullptr) return;
    for (int r = 0; r < 2; ++r) {
      for (int i = 0; i < count; ++i) jacobian[r * count + i] = residuals[r].v[first + i];
    }
  }

  ReprojectionError error_;
  int camera_parameters_;
  bool bend_is_free_;
};

}  // namespace

std::unique_ptr<ceres::CostFunction> MakeCost(CameraModel model, const Eigen::Matrix3d& rotation0,
                                              const BundleCorner& corner, const BoardBend& bend,
                                              bool bend_is_free) {
  return std::make_unique<ReprojectionCost>(ReprojectionError(model, rotation0, corner, bend),
                                            static_cast<int>(CameraParameterNames(model).size()),
                                            bend_is_free);
}

}  // namespace glint::bundle
