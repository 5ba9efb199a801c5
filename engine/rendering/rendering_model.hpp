/// \file The rendering model chosen by a study: PaperModel or SurfaceModel.
#pragma once

#include "engine/rendering/paper_model.hpp"
#include "engine/rendering/surface_model.hpp"

#include <variant>

namespace touchtrial::engine {

/// Copyable, without heap memory; refers to the field's samples.
/// Thread-safe.
class RenderingModel {
 public:
  /// \param field  made for options.model; a field of another model is rendered as a flat wall
  /// \throws Error if Highway's library cannot be loaded
  RenderingModel(FieldView field, const RenderingOptions& options, Gains gains);

  /// PaperModel::force_n or SurfaceModel::force_n.
  /// \param bristle  friction state; a new one for each presentation
  [[nodiscard]] Vec3 force_n(const Vec3& position_mm, const Vec3& velocity_mm_s,
                             Bristle& bristle) const noexcept {
    if (const auto* paper = std::get_if<PaperModel>(&model_)) {
      return paper->force_n(position_mm, velocity_mm_s);
    }
    return std::get_if<SurfaceModel>(&model_)->force_n(position_mm, velocity_mm_s, bristle);
  }

 private:
  std::variant<PaperModel, SurfaceModel> model_;
};

}  // namespace touchtrial::engine
