#include "engine/extraction.hpp"

#include "analysis/measures/evaluation_report.hpp"
#include "core/text.hpp"
#include "engine/evaluation.hpp"
#include "engine/force_field.hpp"
#include "python/arrays.hpp"
#include "python/module.hpp"
#include "python/options.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

namespace touchtrial::python {
namespace {

namespace py = pybind11;

/// The neighbourhood of the forces that the engine computes along with a texture.
constexpr int kForceNeighbourhood = 3;
constexpr int kMaxForceNeighbourhood = 1001;

/// A plane's name, as in `extract --dump`, and the option that requests it; null: always computed.
struct PlaneName {
  std::string_view name;
  bool engine::RequestedPlanes::*requested;
};
constexpr std::array kPlanes = {PlaneName{"image", nullptr},
                                PlaneName{"texture", nullptr},
                                PlaneName{"subband_LL", &engine::RequestedPlanes::sub_bands},
                                PlaneName{"subband_LH", &engine::RequestedPlanes::sub_bands},
                                PlaneName{"subband_HL", &engine::RequestedPlanes::sub_bands},
                                PlaneName{"subband_HH", &engine::RequestedPlanes::sub_bands},
                                PlaneName{"csgv", &engine::RequestedPlanes::csgv},
                                PlaneName{"order", &engine::RequestedPlanes::order},
                                PlaneName{"enhanced", &engine::RequestedPlanes::enhanced},
                                PlaneName{"cartoon", &engine::RequestedPlanes::cartoon},
                                PlaneName{"texture_u8", &engine::RequestedPlanes::picture},
                                PlaneName{"force_tangential", &engine::RequestedPlanes::force}};

engine::RequestedPlanes requested_planes(const std::optional<std::vector<std::string>>& names) {
  if (!names) return engine::RequestedPlanes::all();
  engine::RequestedPlanes requested;
  for (const std::string& name : *names) {
    const auto entry = std::ranges::find(kPlanes, name, &PlaneName::name);
    if (entry == kPlanes.end()) {
      throw py::value_error(
          "planes: there is no " + name + "; choose among " +
          listed(kPlanes, ", ", [](const PlaneName& plane) { return plane.name; }));
    }
    if (entry->requested != nullptr) requested.*entry->requested = true;
  }
  return requested;
}

struct PictureAndForce {
  engine::Mapping mapping = engine::Mapping::offset;
  int neighbourhood = kForceNeighbourhood;
};

PictureAndForce picture_and_force(const std::string& mapping, int neighbourhood) {
  const auto value = value_in(engine::kMappingNames, mapping);
  if (!value) {
    throw py::value_error(
        "mapping: there is no " + mapping + "; choose among " +
        listed(engine::kMappingNames, ", ", [](const auto& named) { return named.name; }));
  }
  if (neighbourhood < 3 || neighbourhood > kMaxForceNeighbourhood || neighbourhood % 2 == 0) {
    throw py::value_error("neighbourhood: is " + std::to_string(neighbourhood) +
                          ", must be odd, from 3 to " + std::to_string(kMaxForceNeighbourhood));
  }
  return {*value, neighbourhood};
}

/// Extracts a texture, and adds the planes that the engine does not compute with it.
template <typename Real>
engine::Extraction<Real> extract_planes(const GreyImage& image,
                                        const engine::ExtractionOptions& options,
                                        const engine::RequestedPlanes& requested,
                                        const PictureAndForce& picture_options) {
  engine::RequestedPlanes computed_with_texture = requested;
  const bool needs_other_picture =
      requested.picture && picture_options.mapping != engine::Mapping::offset;
  const bool needs_other_force =
      requested.force && picture_options.neighbourhood != kForceNeighbourhood;
  computed_with_texture.picture = requested.picture && !needs_other_picture;
  computed_with_texture.force = requested.force && !needs_other_force;
  auto extraction = engine::extract_texture<Real>(image, options, computed_with_texture);
  if (needs_other_picture)
    extraction.picture = engine::texture_picture(extraction.texture, picture_options.mapping);
  if (needs_other_force)
    extraction.force = engine::tangential_force(extraction.texture, picture_options.neighbourhood);
  return extraction;
}

py::list components_of(const std::vector<engine::GaborComponent>& components) {
  py::list pairs;
  for (const engine::GaborComponent& component : components) {
    pairs.append(py::make_tuple(component.frequency_cycles_per_px, component.direction_deg));
  }
  return pairs;
}

template <typename Real>
py::dict extract_as(GreyImage image, const engine::ExtractionOptions& options,
                    const engine::RequestedPlanes& requested,
                    const PictureAndForce& picture_options) {
  engine::Extraction<Real> extraction;
  {
    const py::gil_scoped_release gil_released;
    extraction = extract_planes<Real>(image, options, requested, picture_options);
  }
  py::dict planes;
  planes["image"] = array_of(std::move(image));
  planes["texture"] = array_of(std::move(extraction.texture));
  planes["subband_LL"] = array_of(std::move(extraction.sub_band_ll));
  planes["subband_LH"] = array_of(std::move(extraction.sub_band_lh));
  planes["subband_HL"] = array_of(std::move(extraction.sub_band_hl));
  planes["subband_HH"] = array_of(std::move(extraction.sub_band_hh));
  planes["csgv"] = array_of(std::move(extraction.csgv));
  planes["order"] = array_of(std::move(extraction.order));
  planes["enhanced"] = array_of(std::move(extraction.enhanced));
  planes["cartoon"] = array_of(std::move(extraction.cartoon));
  planes["texture_u8"] = array_of(std::move(extraction.picture));
  planes["force_x"] = array_of(std::move(extraction.force.x));
  planes["force_y"] = array_of(std::move(extraction.force.y));
  planes["components"] = components_of(extraction.components);
  planes["gap"] = extraction.gap;
  planes["steps"] = extraction.steps;
  planes["converged"] = extraction.converged;
  return planes;
}

py::dict extract(const py::object& image, const engine::ExtractionOptions& options,
                 const std::string& mapping, int neighbourhood, bool in_double,
                 const std::optional<std::vector<std::string>>& planes) {
  const engine::RequestedPlanes requested = requested_planes(planes);
  const PictureAndForce picture_options = picture_and_force(mapping, neighbourhood);
  GreyImage grey = grey_image_of(image);
  return in_double ? extract_as<double>(std::move(grey), options, requested, picture_options)
                   : extract_as<float>(std::move(grey), options, requested, picture_options);
}

/// Times the extraction of `extract` without Python, for scripts/bench-python.
double seconds_of_extraction(const py::object& image, bool all_planes) {
  const GreyImage grey = grey_image_of(image);
  const engine::RequestedPlanes requested =
      all_planes ? engine::RequestedPlanes::all() : engine::RequestedPlanes{};
  const py::gil_scoped_release gil_released;
  const auto start = std::chrono::steady_clock::now();
  static_cast<void>(engine::extract_texture<float>(grey, {}, requested));
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string evaluate(const std::vector<py::object>& images, bool sweep) {
  std::vector<analysis::EvaluatedImage> results;
  for (const py::object& image : images) {
    const std::string name =
        is_path(image) ? py::module_::import("os").attr("fsencode")(image).cast<std::string>()
                       : "array " + std::to_string(results.size());
    const GreyImage grey = grey_image_of(image);
    const py::gil_scoped_release gil_released;
    results.push_back({name, engine::evaluate_image(grey, sweep)});
  }
  const py::gil_scoped_release gil_released;
  return analysis::evaluation_json(results);
}

}  // namespace

void add_extraction(py::module_& module) {
  py::class_<engine::ExtractionOptions>(module, "Method", "An extraction method and its options.")
      .def(py::init(&method_options), py::arg("method"), py::arg("seed"),
           "method: JSON, as in a study file's \"methods\".");
  module.def("extract", &extract, py::arg("image"), py::arg("method"), py::arg("mapping"),
             py::arg("neighbourhood"), py::arg("in_double"), py::arg("planes"),
             "The planes of an extraction by name, each an array that owns its memory or None.");
  module.def("_seconds_of_extraction", &seconds_of_extraction, py::arg("image"),
             py::arg("all_planes"), "Times the C++ call, for the benchmark.");
  module.def("evaluate", &evaluate, py::arg("images"), py::arg("sweep"),
             "The text that `touchtrial evaluate --json` prints.");
}

}  // namespace touchtrial::python
