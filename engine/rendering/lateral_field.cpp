#include "engine/rendering/lateral_field.hpp"

#include "engine/rendering/surface_measures.hpp"

#include <stdexcept>

namespace touchtrial::engine {
namespace {

ForceField<double> force_planes(FieldView field) {
  const int height = field.geometry.height_px;
  const int width = field.geometry.width_px;
  ForceField<double> force{Plane<double>(height, width), Plane<double>(height, width)};
  for (std::size_t i = 0; i < field.samples.size(); ++i) {
    force.x.samples()[i] = field.samples[i].force_x;
    force.y.samples()[i] = field.samples[i].force_y;
  }
  return force;
}

}  // namespace

LateralField lateral_field(FieldView field, Gains gains) {
  if (field.empty()) throw std::invalid_argument("lateral_field: the field is empty");
  if (field.model() == ModelKind::paper) return {force_planes(field), gains.tangential_n};
  const TextureField relief = relief_of(field);
  return {force_planes(relief.view()), kStatedLoadN * gains.height_mm / field.geometry.pitch_mm};
}

}  // namespace touchtrial::engine
