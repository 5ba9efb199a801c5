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
  bool engine::WantedPlanes::*wanted;
};
constexpr std::array kPlanes = {PlaneName{"image", nullptr},
                                PlaneName{"texture", nullptr},
                                PlaneName{"subband_LL", &engine::WantedPlanes::sub_bands},
                                PlaneName{"subband_LH", &engine::WantedPlanes::sub_bands},
                                PlaneName{"subband_HL", &engine::WantedPlanes::sub_bands},
                                PlaneName{"subband_HH", &engine::WantedPlanes::sub_bands},
                                PlaneName{"csgv", &engine::WantedPlanes::csgv},
                                PlaneName{"order", &engine::WantedPlanes::order},
                                PlaneName{"enhanced", &engine::WantedPlanes::enhanced},
                                PlaneName{"cartoon", &engine::WantedPlanes::cartoon},
                                PlaneName{"texture_u8", &engine::WantedPlanes::picture},
                                PlaneName{"force_tangential", &engine::WantedPlanes::force}};

engine::WantedPlanes wanted_planes(const std::optional<std::vector<std::string>>& names) {
  if (!names) return engine::WantedPlanes::all();
  engine::WantedPlanes wanted;
  for (const std::string& name : *names) {
    const auto found = std::ranges::find(kPlanes, name, &PlaneName::name);
    if (found == kPlanes.end()) {
      throw py::value_error("planes: there is no " + name + "; choose among " +
                            listed(kPlanes, ", ", [](const PlaneName& one) { return one.name; }));
    }
    if (found->wanted != nullptr) wanted.*found->wanted = true;
  }
  return wanted;
}

struct PictureAndForce {
  engine::Mapping mapping = engine::Mapping::offset;
  int neighbourhood = kForceNeighbourhood;
};

PictureAndForce picture_and_force(const std::string& mapping, int neighbourhood) {
  const auto chosen = value_in(engine::kMappingNames, mapping);
  if (!chosen) {
    throw py::value_error(
        "mapping: there is no " + mapping + "; choose among " +
        listed(engine::kMappingNames, ", ", [](const auto& one) { return one.name; }));
  }
  if (neighbourhood < 3 || neighbourhood > kMaxForceNeighbourhood || neighbourhood % 2 == 0) {
    throw py::value_error("neighbourhood: is " + std::to_string(neighbourhood) +
                          ", must be odd, from 3 to " + std::to_string(kMaxForceNeighbourhood));
  }
  return {*chosen, neighbourhood};
}

/// Extracts, and adds the planes that the engine does not compute along with a texture.
template <typename Real>
engine::Extraction<Real> extracted(const GreyImage& image, const engine::ExtractionOptions& options,
                                   const engine::WantedPlanes& wanted,
                                   const PictureAndForce& further) {
  engine::WantedPlanes at_once = wanted;
  const bool other_picture = wanted.picture && further.mapping != engine::Mapping::offset;
  const bool other_force = wanted.force && further.neighbourhood != kForceNeighbourhood;
  at_once.picture = wanted.picture && !other_picture;
  at_once.force = wanted.force && !other_force;
  auto extraction = engine::extract_texture<Real>(image, options, at_once);
  if (other_picture)
    extraction.picture = engine::texture_picture(extraction.texture, further.mapping);
  if (other_force)
    extraction.force = engine::tangential_force(extraction.texture, further.neighbourhood);
  return extraction;
}

py::list components_of(const std::vector<engine::GaborComponent>& components) {
  py::list pairs;
  for (const engine::GaborComponent& one : components) {
    pairs.append(py::make_tuple(one.frequency_cycles_per_px, one.direction_deg));
  }
  return pairs;
}

template <typename Real>
py::dict extract_as(GreyImage image, const engine::ExtractionOptions& options,
                    const engine::WantedPlanes& wanted, const PictureAndForce& further) {
  engine::Extraction<Real> made;
  {
    const py::gil_scoped_release gil_released;
    made = extracted<Real>(image, options, wanted, further);
  }
  py::dict planes;
  planes["image"] = array_of(std::move(image));
  planes["texture"] = array_of(std::move(made.texture));
  planes["subband_LL"] = array_of(std::move(made.sub_band_ll));
  planes["subband_LH"] = array_of(std::move(made.sub_band_lh));
  planes["subband_HL"] = array_of(std::move(made.sub_band_hl));
  planes["subband_HH"] = array_of(std::move(made.sub_band_hh));
  planes["csgv"] = array_of(std::move(made.csgv));
  planes["order"] = array_of(std::move(made.order));
  planes["enhanced"] = array_of(std::move(made.enhanced));
  planes["cartoon"] = array_of(std::move(made.cartoon));
  planes["texture_u8"] = array_of(std::move(made.picture));
  planes["force_x"] = array_of(std::move(made.force.x));
  planes["force_y"] = array_of(std::move(made.force.y));
  planes["components"] = components_of(made.components);
  planes["gap"] = made.gap;
  planes["steps"] = made.steps;
  planes["converged"] = made.converged;
  return planes;
}

py::dict extract(const py::object& image, const engine::ExtractionOptions& options,
                 const std::string& mapping, int neighbourhood, bool in_double,
                 const std::optional<std::vector<std::string>>& planes) {
  const engine::WantedPlanes wanted = wanted_planes(planes);
  const PictureAndForce further = picture_and_force(mapping, neighbourhood);
  GreyImage grey = grey_image_of(image);
  return in_double ? extract_as<double>(std::move(grey), options, wanted, further)
                   : extract_as<float>(std::move(grey), options, wanted, further);
}

/// The same extraction as `extract` makes, timed without Python: for scripts/bench-python.
double seconds_of_extraction(const py::object& image, bool all_planes) {
  const GreyImage grey = grey_image_of(image);
  const engine::WantedPlanes wanted =
      all_planes ? engine::WantedPlanes::all() : engine::WantedPlanes{};
  const py::gil_scoped_release gil_released;
  const auto start = std::chrono::steady_clock::now();
  static_cast<void>(engine::extract_texture<float>(grey, {}, wanted));
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string evaluate(const std::vector<py::object>& images, bool sweep) {
  std::vector<analysis::EvaluatedImage> evaluated;
  for (const py::object& image : images) {
    const std::string name =
        is_path(image) ? py::module_::import("os").attr("fsencode")(image).cast<std::string>()
                       : "array " + std::to_string(evaluated.size());
    const GreyImage grey = grey_image_of(image);
    const py::gil_scoped_release gil_released;
    evaluated.push_back({name, engine::evaluate_image(grey, sweep)});
  }
  const py::gil_scoped_release gil_released;
  return analysis::evaluation_json(evaluated);
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
