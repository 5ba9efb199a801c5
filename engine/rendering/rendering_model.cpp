#include "engine/rendering/rendering_model.hpp"

namespace touchtrial::engine {
namespace {

std::variant<PaperModel, SurfaceModel> model_of(FieldView field, const RenderingOptions& options,
                                                Gains gains) noexcept {
  if (options.model == ModelKind::surface) return SurfaceModel(field, options, gains);
  return PaperModel(field, options, gains);
}

}  // namespace

RenderingModel::RenderingModel(FieldView field, const RenderingOptions& options,
                               Gains gains) noexcept
    : model_(model_of(field, options, gains)) {}

}  // namespace touchtrial::engine
