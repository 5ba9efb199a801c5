/// \file The rendering model of a study, independent of its kind.
#pragma once

#include "engine/rendering/paper_model.hpp"
#include "engine/rendering/surface_model.hpp"

#include <variant>

namespace touchtrial::engine {

/// The model chosen by a study. Copyable, without heap memory; refers to the field's samples.
/// Thread-safe.
class RenderingModel {
 public:
  /// \param field  made for options.model; the field of another model is the flat wall
  /// \throws Error if Highway's library cannot be used
  RenderingModel(FieldView field, const RenderingOptions& options, Gains gains);

  /// PaperModel::force_n or SurfaceModel::force_n.
  /// \param touch  the state that a presentation keeps from tick to tick; a new one for each
  [[nodiscard]] Vec3 force_n(const Vec3& position_mm, const Vec3& velocity_mm_s,
                             Bristle& touch) const noexcept {
    if (const auto* paper = std::get_if<PaperModel>(&model_)) {
      return paper->force_n(position_mm, velocity_mm_s);
    }
    return std::get_if<SurfaceModel>(&model_)->force_n(position_mm, velocity_mm_s, touch);
  }

 private:
  std::variant<PaperModel, SurfaceModel> model_;
};

}  // namespace touchtrial::engine
