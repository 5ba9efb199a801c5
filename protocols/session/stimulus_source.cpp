#include "protocols/session/stimulus_source.hpp"

#include "core/errors.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace touchtrial::session {
namespace {

constexpr std::size_t kLeastPage = 4096;

void touch(std::span<const std::byte> bytes) noexcept {
  const auto read = [](const std::byte& byte) {
    static_cast<void>(*static_cast<const volatile std::byte*>(&byte));
  };
  for (std::size_t i = 0; i < bytes.size(); i += kLeastPage) read(bytes[i]);
  if (!bytes.empty()) read(bytes.back());
}

}  // namespace

StimulusSource::StimulusSource(const engine::Pack& pack, const engine::RenderingOptions& rendering)
    : folder_(pack.folder().string()) {
  for (const engine::PackEntry& entry : pack.manifest().entries) {
    fields_.push_back(pack.map(entry.code));
    const engine::FieldView view = fields_.back().view();
    if (view.model() != rendering.model) {
      throw FileError(one_line(folder_ + ": field " + entry.code +
                               " is of another rendering model than the study; run `touchtrial "
                               "prepare`"));
    }
    models_.emplace(entry.code, engine::RenderingModel(view, rendering, entry.gains));
    // Made of a field, which is read like any other, so that the servo takes as long.
    if (!flat_) flat_.emplace(view, rendering, engine::Gains{});
    if (models_.size() == 1) plane_ = view.geometry;
    plane_.height_px = std::min(plane_.height_px, view.geometry.height_px);
    plane_.width_px = std::min(plane_.width_px, view.geometry.width_px);
  }
  if (models_.empty()) {
    throw FileError(one_line(folder_ + ": the pack has no field; run `touchtrial prepare`"));
  }
}

void StimulusSource::fetch() const noexcept {
  for (const engine::MappedField& field : fields_) {
    const engine::FieldView view = field.view();
    touch(std::as_bytes(view.samples));
    touch(std::as_bytes(view.coefficients));
  }
}

const engine::RenderingModel& StimulusSource::model(const std::string& code) const {
  const auto found = models_.find(code);
  if (found == models_.end()) {
    throw FileError(
        one_line(folder_ + ": the pack has no field " + code + "; run `touchtrial prepare`"));
  }
  return found->second;
}

}  // namespace touchtrial::session
