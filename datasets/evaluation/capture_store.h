// The views of one material under one condition, made once for all methods that fit to them.
#pragma once

#include <filesystem>
#include <vector>

#include "datasets/synth/view_set.h"

namespace glint {

// Each method has a capture folder of its own, since a capture has one fit. The first is rendered
// and written; the others get hard links to its files (copies where links cannot be).
class CaptureStore {
 public:
  CaptureStore(const MaterialSource& material, const ViewSetOptions& views,
               const CommonOptions& common);

  // Makes `capture` hold the views; its fits stay. Throws UserError, EnvironmentError.
  void Provide(const std::filesystem::path& capture);

  // Makes `capture` hold the fit of `fitted` too: both have these views.
  void ShareFit(const std::filesystem::path& fitted, const std::filesystem::path& capture) const;

  ReflectanceConvention convention() const;

 private:
  const MaterialSource& material_;
  const ViewSetOptions& views_;
  const CommonOptions& common_;
  std::vector<std::filesystem::path> made_;
};

}  // namespace glint
