#include "engine/rendering/rendering_model.hpp"

#include "engine/rendering/model_parts.hpp"

namespace touchtrial::engine {
namespace {

std::variant<PaperModel, SurfaceModel> model_of(FieldView field, const RenderingOptions& options,
                                                Gains gains) {
  switch (options.model) {
    case ModelKind::surface:
      return SurfaceModel(field, options, gains);
    case ModelKind::paper:
      break;
  }
  return PaperModel(field, options, gains);
}

}  // namespace

RenderingModel::RenderingModel(FieldView field, const RenderingOptions& options, Gains gains)
    : model_(model_of(field, options, gains)) {}

ModelParts parts_of(ModelKind kind) noexcept {
  switch (kind) {
    case ModelKind::surface:
      return surface_parts();
    case ModelKind::paper:
      break;
  }
  return paper_parts();
}

}  // namespace touchtrial::engine
