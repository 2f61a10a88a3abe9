// glint._glint: what Python needs of Glint's libraries, as plain functions of arrays. The package's
// own Python files (python/glint) make the interface of them; _glint.pyi has their types.
//
// Arrays are float32 and planar, [planes, height, width], rows as in the maps; brdf() is float64.
// What is returned belongs to Python: nothing is copied on the way out, and on the way in only what
// is of another type or not contiguous. The GIL is released while files are read and written and
// while images are rendered.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/errors/errors.h"
#include "base/files/hash.h"
#include "base/images/exr_rows.h"
#include "base/images/image.h"
#include "base/reflectance/brdf.h"
#include "base/stages/stages.h"
#include "fitting/render/renderer.h"

namespace glint {
namespace {

namespace py = pybind11;

using FloatArray = py::array_t<float, py::array::c_style | py::array::forcecast>;
using DoubleArray = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Strings = std::vector<std::string>;

// Read and written together, so that a file is in memory once.
constexpr int kRowsAtOnce = 256;

std::string ShapeText(const py::array& array) {
  std::string text;
  for (py::ssize_t i = 0; i < array.ndim(); ++i) {
    text += (i > 0 ? "x" : "") + std::to_string(array.shape(i));
  }
  return text;
}

// [count, height, width]; `count` 0: any.
void RequirePlanes(const py::array& array, const char* name, py::ssize_t count) {
  const bool well = array.ndim() == 3 && array.shape(0) > 0 && array.shape(1) > 0 &&
                    array.shape(2) > 0 && (count == 0 || array.shape(0) == count);
  if (well) return;
  throw std::invalid_argument(std::string(name) + ": found an array of " + ShapeText(array) + "; " +
                              (count > 0 ? std::to_string(count) : "planes") +
                              " x height x width are expected");
}

FloatArray NewPlanes(py::ssize_t planes, py::ssize_t height, py::ssize_t width) {
  return FloatArray(std::vector<py::ssize_t>{planes, height, width});
}

// --- Files ---

std::vector<int> IndicesOf(const std::string& file, const Strings& present, const Strings& wanted) {
  std::vector<int> indices;
  for (const std::string& name : wanted) {
    const auto found = std::find(present.begin(), present.end(), name);
    if (found == present.end()) {
      std::string list;
      for (const std::string& channel : present) list += (list.empty() ? "" : ", ") + channel;
      throw UserError(file, name, "no such channel", "the file has " + list);
    }
    indices.push_back(static_cast<int>(found - present.begin()));
  }
  return indices;
}

void ReadInto(ExrReader* reader, const std::vector<int>& channels, float* planes) {
  const size_t width = static_cast<size_t>(reader->width());
  const size_t texels = width * static_cast<size_t>(reader->height());
  for (int first = 0; first < reader->height(); first += kRowsAtOnce) {
    const Image rows = reader->Read(first, std::min(kRowsAtOnce, reader->height() - first));
    for (size_t plane = 0; plane < channels.size(); ++plane) {
      const auto values = rows.channel(channels[plane]);
      std::copy(values.begin(), values.end(),
                planes + plane * texels + static_cast<size_t>(first) * width);
    }
  }
}

// Planes of the named channels, or of all in the file's order.
py::tuple ReadPlanes(const std::string& file, const std::optional<Strings>& wanted) {
  ExrReader reader(file);
  const Strings names = wanted.value_or(reader.channels());
  const std::vector<int> channels = IndicesOf(file, reader.channels(), names);
  FloatArray planes =
      NewPlanes(static_cast<py::ssize_t>(names.size()), reader.height(), reader.width());
  {
    float* const values = planes.mutable_data();
    const py::gil_scoped_release released;
    ReadInto(&reader, channels, values);
  }
  return py::make_tuple(planes, names, reader.attributes());
}

void WritePlanes(const std::string& file, const FloatArray& planes, const Strings& channels,
                 const std::map<std::string, std::string>& attributes) {
  RequirePlanes(planes, "planes", static_cast<py::ssize_t>(channels.size()));
  const int height = static_cast<int>(planes.shape(1)), width = static_cast<int>(planes.shape(2));
  const float* const values = planes.data();
  const py::gil_scoped_release released;
  ExrWriter writer(file, width, height, channels, attributes);
  const size_t texels = static_cast<size_t>(width) * static_cast<size_t>(height);
  for (int first = 0; first < height; first += kRowsAtOnce) {
    Image rows(width, std::min(kRowsAtOnce, height - first), channels);
    for (size_t plane = 0; plane < channels.size(); ++plane) {
      const float* from =
          values + plane * texels + static_cast<size_t>(first) * static_cast<size_t>(width);
      std::copy(from, from + rows.pixels(), rows.channel(static_cast<int>(plane)).begin());
    }
    writer.Write(rows);
  }
  writer.Close();
}

void WritePngPlanes(const std::string& file, const FloatArray& planes, int bits) {
  RequirePlanes(planes, "planes", 0);
  const auto count = static_cast<size_t>(planes.shape(0));
  if (count != 1 && count != 3 && count != 4) {
    throw std::invalid_argument("planes: found " + std::to_string(count) +
                                " of them; a PNG has 1, 3 or 4");
  }
  if (bits != 8 && bits != 16) {
    throw std::invalid_argument("bits: found " + std::to_string(bits) + "; a PNG has 8 or 16");
  }
  Image image(static_cast<int>(planes.shape(2)), static_cast<int>(planes.shape(1)),
              Strings(count, "Y"));
  std::copy(planes.data(), planes.data() + planes.size(), image.samples.begin());
  const py::gil_scoped_release released;
  WritePng(file, image, bits);
}

// --- Rendering ---

struct Scene {
  SamplePlane plane;
  ReflectanceConvention convention;
  View view;
};

Scene MakeScene(const FloatArray& planes, const std::array<double, 2>& size_mm,
                const std::string& convention, const Vec3d& camera_mm, const Vec3d& light_mm,
                const Vec3d& light_rgb, const Vec3d& ambient_rgb, double exposure) {
  RequirePlanes(planes, "maps", kSvbrdfPlanes);
  Scene scene;
  scene.convention = ParseReflectanceConvention(convention);
  scene.plane = {static_cast<int>(planes.shape(2)),
                 static_cast<int>(planes.shape(1)),
                 size_mm[0],
                 size_mm[1],
                 scene.convention.sampling,
                 {}};
  scene.view.camera_in_sample_mm = camera_mm;
  scene.view.light_in_sample_mm = light_mm;
  scene.view.light_rgb = light_rgb;
  scene.view.ambient_rgb = ambient_rgb;
  scene.view.exposure = exposure;
  return scene;
}

FloatArray Render(const FloatArray& maps, const std::array<double, 2>& size_mm,
                  const std::string& convention, const Vec3d& camera_mm, const Vec3d& light_mm,
                  const Vec3d& light_rgb, const Vec3d& ambient_rgb, double exposure, int threads) {
  const Scene scene =
      MakeScene(maps, size_mm, convention, camera_mm, light_mm, light_rgb, ambient_rgb, exposure);
  FloatArray image = NewPlanes(3, maps.shape(1), maps.shape(2));
  const std::span<const float> values(maps.data(), static_cast<size_t>(maps.size()));
  float* const radiance = image.mutable_data();
  {
    const py::gil_scoped_release released;
    RenderView(values, scene.plane, scene.view, scene.convention, radiance, threads);
  }
  return image;
}

FloatArray RenderGradients(const FloatArray& maps, const FloatArray& radiance_gradient,
                           const std::array<double, 2>& size_mm, const std::string& convention,
                           const Vec3d& camera_mm, const Vec3d& light_mm, const Vec3d& light_rgb,
                           const Vec3d& ambient_rgb, double exposure, int threads) {
  const Scene scene =
      MakeScene(maps, size_mm, convention, camera_mm, light_mm, light_rgb, ambient_rgb, exposure);
  RequirePlanes(radiance_gradient, "radiance_gradient", 3);
  if (radiance_gradient.shape(1) != maps.shape(1) || radiance_gradient.shape(2) != maps.shape(2)) {
    throw std::invalid_argument("radiance_gradient: found " + ShapeText(radiance_gradient) +
                                "; the maps are " + ShapeText(maps));
  }
  FloatArray gradient = NewPlanes(kSvbrdfPlanes, maps.shape(1), maps.shape(2));
  const std::span<const float> values(maps.data(), static_cast<size_t>(maps.size()));
  const std::span<float> slopes(gradient.mutable_data(), static_cast<size_t>(gradient.size()));
  const ViewImage image{scene.view, radiance_gradient.data()};
  {
    const py::gil_scoped_release released;
    AdjointOfViews(values, scene.plane, {&image, 1}, scene.convention, slopes, threads);
  }
  return gradient;
}

void RequireRows(const DoubleArray& array, const char* name, py::ssize_t rows, bool vectors) {
  const bool well = array.ndim() == (vectors ? 2 : 1) && array.shape(0) == rows &&
                    (!vectors || array.shape(1) == 3);
  if (well) return;
  throw std::invalid_argument(std::string(name) + ": found an array of " + ShapeText(array) + "; " +
                              std::to_string(rows) + (vectors ? " x 3 are" : " are") + " expected");
}

// One row for each evaluation; directions and normals are unit.
DoubleArray Brdf(const DoubleArray& light, const DoubleArray& camera, const DoubleArray& normal,
                 const DoubleArray& diffuse, const DoubleArray& specular,
                 const DoubleArray& roughness, bool one_minus_specular, double narrow_share,
                 double narrow_ratio, double coat_f0, int tail, double anisotropy_ratio,
                 double anisotropy_deg) {
  const py::ssize_t rows = roughness.ndim() == 1 ? roughness.shape(0) : 0;
  RequireRows(light, "light", rows, true);
  RequireRows(camera, "camera", rows, true);
  RequireRows(normal, "normal", rows, true);
  RequireRows(diffuse, "diffuse", rows, true);
  RequireRows(specular, "specular", rows, true);
  RequireRows(roughness, "roughness", rows, false);
  ReflectanceConvention convention;
  if (one_minus_specular) convention.diffuse_weight = DiffuseWeight::kOneMinusSpecular;
  convention.lobes = {
      narrow_share, narrow_ratio, coat_f0, tail, {anisotropy_ratio, anisotropy_deg}};
  DoubleArray values(std::vector<py::ssize_t>{rows, 3});
  double* const out = values.mutable_data();
  const double dark[3] = {0, 0, 0};
  for (py::ssize_t row = 0; row < rows; ++row) {
    const py::ssize_t at = 3 * row;
    TexelSvbrdf<double> texel;
    std::copy_n(normal.data() + at, 3, texel.normal);
    std::copy_n(diffuse.data() + at, 3, texel.diffuse);
    std::copy_n(specular.data() + at, 3, texel.specular);
    texel.roughness = roughness.data()[row];
    const auto geometry = MakeTexelGeometry(light.data() + at, camera.data() + at, dark, dark);
    EvaluateBrdf(texel, geometry, convention, out + at);
  }
  return values;
}

// Errors become those of glint.errors, by their exit code.
void TranslateErrors(std::exception_ptr pointer) {
  if (!pointer) return;
  try {
    std::rethrow_exception(std::move(pointer));
  } catch (const Error& error) {
    const py::object type =
        py::module_::import("glint.errors").attr("error_type")(static_cast<int>(error.code()));
    PyErr_SetString(type.ptr(), error.what());
  }
}

}  // namespace
}  // namespace glint

PYBIND11_MODULE(_glint, module) {
  namespace py = pybind11;
  using py::arg;
  module.doc() = "Glint's libraries as functions of arrays; the package glint is made of them.";
  module.attr("__version__") = GLINT_VERSION;
  py::register_exception_translator(&glint::TranslateErrors);

  module.def("read_exr", &glint::ReadPlanes, arg("file"), arg("channels") = py::none(),
             "Channels of an EXR image as (planes, names, attributes).");
  module.def("write_exr", &glint::WritePlanes, arg("file"), arg("planes"), arg("channels"),
             arg("attributes"), "Writes planes as the channels of a float32 EXR image.");
  module.def("write_png", &glint::WritePngPlanes, arg("file"), arg("planes"), arg("bits"),
             "Writes 1, 3 or 4 planes, clamped to [0, 1], as they are.");
  module.def(
      "hash_file", [](const std::string& file) { return glint::HashFile(file); }, arg("file"),
      "The hash of a file's bytes, as manifests have it.");
  module.def(
      "convention",
      [](const std::string& text) {
        return glint::ToString(glint::ParseReflectanceConvention(text));
      },
      arg("text"), "A reflectance convention in the words of manifests.");
  module.def(
      "stages",
      [] {
        std::vector<std::string> names;
        for (const glint::StageKind& stage : glint::Stages()) names.emplace_back(stage.name);
        return names;
      },
      "Names of all stages in their order.");
  module.def(
      "views_stage", [] { return std::string(glint::LastGiving(glint::Gives::kViews)->name); },
      "Name of the stage whose views are fitted.");
  module.def("render", &glint::Render, arg("maps"), arg("size_mm"), arg("convention"),
             arg("camera_mm"), arg("light_mm"), arg("light_rgb"), arg("ambient_rgb"),
             arg("exposure"), arg("threads"), "Radiance, [3, height, width].");
  module.def("render_gradients", &glint::RenderGradients, arg("maps"), arg("radiance_gradient"),
             arg("size_mm"), arg("convention"), arg("camera_mm"), arg("light_mm"), arg("light_rgb"),
             arg("ambient_rgb"), arg("exposure"), arg("threads"),
             "The adjoint of render: ∂loss/∂maps, [10, height, width], from ∂loss/∂radiance.");
  module.def("brdf", &glint::Brdf, arg("light"), arg("camera"), arg("normal"), arg("diffuse"),
             arg("specular"), arg("roughness"), arg("one_minus_specular"), arg("narrow_share"),
             arg("narrow_ratio"), arg("coat_f0"), arg("tail"), arg("anisotropy_ratio"),
             arg("anisotropy_deg"), "The BRDF row by row, [rows, 3], in 1/sr.");
}
