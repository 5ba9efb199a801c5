/// \file Either rendering model, for callers that need not know which.
#pragma once

#include "engine/rendering/bristle.hpp"
#include "engine/rendering/paper_model.hpp"
#include "engine/rendering/surface_model.hpp"

#include <variant>

namespace touchtrial::engine {

/// The model that a study asks for. Copyable, no heap; refers to the field's numbers. Thread-safe.
class RenderingModel {
 public:
  /// \param field  made for options.model; of another model, it is the flat wall
  RenderingModel(FieldView field, const RenderingOptions& options, Gains gains) noexcept;

  /// PaperModel::force_n or SurfaceModel::force_n.
  /// \param touch  what the presentation remembers from tick to tick; new for each
  [[nodiscard]] Vec3 force_n(Vec3 position_mm, Vec3 velocity_mm_s, Bristle& touch) const noexcept {
    if (const auto* paper = std::get_if<PaperModel>(&model_)) {
      return paper->force_n(position_mm, velocity_mm_s);
    }
    return std::get_if<SurfaceModel>(&model_)->force_n(position_mm, velocity_mm_s, touch);
  }

 private:
  std::variant<PaperModel, SurfaceModel> model_;
};

}  // namespace touchtrial::engine
