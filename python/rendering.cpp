#include "engine/rendering/field_statistics.hpp"
#include "engine/rendering/gains.hpp"
#include "engine/rendering/rendering_model.hpp"
#include "python/arrays.hpp"
#include "python/module.hpp"
#include "python/options.hpp"
#include "study/stimulus_field.hpp"
#include "study/study_options.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

namespace touchtrial::python {
namespace {

namespace py = pybind11;

/// A texture on the plane with its gains.
class Field {
 public:
  Field(engine::TextureField field, engine::RenderingOptions options)
      : field_(std::move(field)), options_(std::move(options)) {}

  [[nodiscard]] engine::FieldView view() const { return field_.view(); }
  [[nodiscard]] const engine::RenderingOptions& options() const { return options_; }
  [[nodiscard]] engine::Gains gains() const { return gains_; }
  [[nodiscard]] bool over_budget() const { return over_budget_; }
  void set_gains(engine::Gains gains, bool over_budget) {
    gains_ = gains;
    over_budget_ = over_budget;
  }

 private:
  engine::TextureField field_;
  engine::RenderingOptions options_;
  engine::Gains gains_;
  bool over_budget_ = false;
};

/// The source of a field: an image, or an extracted texture.
struct FieldSource {
  GreyImage image;
  Plane<double> texture;
};

FieldSource read_source(const py::object& source) {
  const bool is_texture = !is_path(source) && py::module_::import("numpy")
                                                      .attr("asarray")(source)
                                                      .attr("dtype")
                                                      .attr("kind")
                                                      .cast<std::string>() == "f";
  if (is_texture) return {{}, plane_of(source, "texture")};
  return {grey_image_of(source), {}};
}

engine::TextureField make_field(const FieldSource& source, const engine::ExtractionOptions& method,
                                const engine::RenderingOptions& rendering) {
  if (source.image.empty()) return engine::make_texture_field(source.texture, rendering);
  std::optional<study::ExtractedTexture> unused_cache;
  return study::build_field(source.image, method, rendering, unused_cache, false).field;
}

/// Fields with common gains, like a study's stimuli.
std::vector<std::shared_ptr<Field>> force_fields(const std::vector<py::object>& sources,
                                                 const engine::ExtractionOptions& method,
                                                 const std::string& rendering) {
  if (sources.empty()) throw py::value_error("force_fields: give at least one image or texture");
  const engine::RenderingOptions options = rendering_options(rendering);
  std::vector<std::shared_ptr<Field>> fields;
  std::vector<engine::FieldView> views;
  for (const py::object& object : sources) {
    const FieldSource source = read_source(object);
    const py::gil_scoped_release gil_released;
    fields.push_back(std::make_shared<Field>(make_field(source, method, options), options));
    views.push_back(fields.back()->view());
  }
  const py::gil_scoped_release gil_released;
  const engine::StudyGains gains = engine::choose_gains(views, options);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    fields[i]->set_gains(gains.per_field[i], gains.over_budget);
  }
  return fields;
}

py::array heights_of(const py::object& self) {
  const engine::FieldView view = self.cast<const Field&>().view();
  return read_only(py::array_t<float>({view.geometry.height_px, view.geometry.width_px},
                                      view.heights.data(), self));
}

py::array lateral_force_of(const Field& field) {
  engine::LateralField lateral;
  {
    const py::gil_scoped_release gil_released;
    lateral = engine::lateral_field(field.view(), field.gains());
  }
  const engine::ForceField<double>& force = lateral.force;
  py::array_t<double> newtons({force.x.height(), force.x.width(), 2});
  double* output = newtons.mutable_data();
  for (std::size_t i = 0; i < force.x.size(); ++i) {
    *output++ = lateral.n_per_grey * force.x.samples()[i];
    *output++ = lateral.n_per_grey * force.y.samples()[i];
  }
  return newtons;
}

py::dict statistics_of(const Field& field) {
  engine::FieldStatistics values;
  {
    const py::gil_scoped_release gil_released;
    values = engine::field_statistics(field.view(), field.gains(), field.options());
  }
  py::dict statistics;
  statistics["tangential_rms_n"] = values.tangential_rms_n;
  statistics["tangential_p999_n"] = values.tangential_p999_n;
  statistics["normal_rms_n"] = values.normal_rms_n;
  statistics["stiffness_p99_n_per_mm"] = values.stiffness_p99_n_per_mm;
  statistics["share_below_1_mm"] = values.share_below_1_mm;
  statistics["share_above_250_hz"] = values.share_above_250_hz;
  return statistics;
}

py::dict gains_of(const Field& field) {
  py::dict gains;
  for (const engine::NamedGain& gain : engine::kGains) {
    gains[std::string(gain.name).c_str()] = field.gains().*gain.value;
  }
  return gains;
}

/// Backward differences, as in a real-time loop; the first velocity is 0.
std::vector<Vec3> differences(const double* path, std::size_t count, double dt_s) {
  std::vector<Vec3> velocities(count);
  for (std::size_t i = 1; i < count; ++i) {
    const double* row = path + 3 * i;
    velocities[i] = {(row[0] - row[-3]) / dt_s, (row[1] - row[-2]) / dt_s,
                     (row[2] - row[-1]) / dt_s};
  }
  return velocities;
}

std::vector<Vec3> velocities_for(const py::array_t<double>& path, const py::object& velocity_array,
                                 std::optional<double> dt_s) {
  const auto count = static_cast<std::size_t>(path.shape(0));
  if (dt_s && !velocity_array.is_none()) {
    throw py::value_error("render: give dt_s or velocities_mm_s, not both");
  }
  if (dt_s) {
    if (!(*dt_s > 0.0)) throw py::value_error("dt_s: must be above 0");
    return differences(path.data(), count, *dt_s);
  }
  if (velocity_array.is_none()) return std::vector<Vec3>(count);
  const py::array_t<double> velocities = matrix_of(velocity_array, "velocities_mm_s", 3);
  if (velocities.shape(0) != path.shape(0)) {
    throw py::value_error("velocities_mm_s: has " + std::to_string(velocities.shape(0)) +
                          " rows, and the path has " + std::to_string(path.shape(0)));
  }
  std::vector<Vec3> rows(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double* row = velocities.data() + 3 * i;
    rows[i] = {row[0], row[1], row[2]};
  }
  return rows;
}

py::array_t<double> render(const Field& field, const py::object& path_mm,
                           std::optional<double> dt_s, const py::object& velocities_mm_s) {
  const py::array_t<double> path = matrix_of(path_mm, "path_mm", 3);
  const std::vector<Vec3> velocities = velocities_for(path, velocities_mm_s, dt_s);
  py::array_t<double> forces({path.shape(0), py::ssize_t{3}});
  const double* position = path.data();
  double* output = forces.mutable_data();
  const py::gil_scoped_release gil_released;
  const engine::RenderingModel model(field.view(), field.options(), field.gains());
  engine::Bristle touch;
  for (const Vec3& velocity : velocities) {
    const Vec3 force = model.force_n({position[0], position[1], position[2]}, velocity, touch);
    position += 3;
    *output++ = force.x;
    *output++ = force.y;
    *output++ = force.z;
  }
  return forces;
}

}  // namespace

void add_rendering(py::module_& module) {
  py::class_<Field, std::shared_ptr<Field>>(
      module, "Field",
      "A texture on the virtual plane, with the gains from grey levels to newtons.")
      .def_property_readonly(
          "heights", &heights_of,
          "(H, W) float32, read-only and without a copy: for the model paper the "
          "filtered texture, for surface the coefficients of its spline; grey "
          "levels.")
      .def_property_readonly(
          "shape",
          [](const Field& field) {
            return std::pair(field.view().geometry.height_px, field.view().geometry.width_px);
          },
          "Height and width, pixels.")
      .def_property_readonly(
          "size_mm",
          [](const Field& field) {
            return std::pair(field.view().geometry.height_mm(), field.view().geometry.width_mm());
          },
          "Height and width of the textured plane, mm.")
      .def_property_readonly(
          "pitch_mm", [](const Field& field) { return field.view().geometry.pitch_mm; },
          "Millimetres per pixel.")
      .def_property_readonly(
          "rendering",
          [](const Field& field) {
            const std::string text = study::written_rendering(field.options());
            return py::module_::import("json").attr("loads")(text);
          },
          "All rendering options.")
      .def_property_readonly("gains", &gains_of,
                             "tangential_n and normal_n (paper) or height_mm (surface) per grey "
                             "level; the others are 0.")
      .def_property_readonly("over_budget", &Field::over_budget,
                             "Whether explicit gains exceed the stiffness budget.")
      .def("lateral_force", &lateral_force_of,
           "(H, W, 2) newtons at the pixels' centres, x then y, before the force limit is applied; "
           "for "
           "surface at a load of 0.7 N.")
      .def("statistics", &statistics_of,
           "Numbers that predict how the field feels; docs/method.md defines them.");
  module.def("force_fields", &force_fields, py::arg("sources"), py::arg("method"),
             py::arg("rendering"), "Fields of images or textures with common gains.");
  module.def("render", &render, py::arg("field"), py::arg("path_mm"), py::arg("dt_s") = py::none(),
             py::arg("velocities_mm_s") = py::none(),
             "The force on a stylus along a path, (N, 3) newtons, by the servo's rendering model.");
}

}  // namespace touchtrial::python
