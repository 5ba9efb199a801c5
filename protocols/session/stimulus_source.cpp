#include "protocols/session/stimulus_source.hpp"

#include "core/errors.hpp"
#include "study/protocol.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>

namespace touchtrial::session {
namespace {

constexpr std::size_t kMinPage = 4096;

void read_pages(std::span<const std::byte> bytes) noexcept {
  const auto read = [](const std::byte& byte) {
    static_cast<void>(*static_cast<const volatile std::byte*>(&byte));
  };
  for (std::size_t i = 0; i < bytes.size(); i += kMinPage) read(bytes[i]);
  if (!bytes.empty()) read(bytes.back());
}

}  // namespace

StimulusSource::StimulusSource(const engine::Pack& pack, const engine::RenderingOptions& rendering)
    : folder_(pack.folder().string()), rendering_(rendering) {
  for (const engine::PackEntry& entry : pack.manifest().entries) {
    fields_.push_back(pack.map(entry.code));
    const engine::FieldView view = fields_.back().view();
    if (view.model != rendering.model) {
      throw FileError(
          one_line(folder_ + ": field " + entry.code +
                   " has a rendering model that differs from the study's; run `touchtrial "
                   "prepare`"));
    }
    stimuli_.emplace(entry.code, Stimulus{view, entry.gains,
                                          engine::RenderingModel(view, rendering, entry.gains)});
    // The blank plane is made from a field, so that its computation takes as long as a texture's.
    if (!blank_plane_) blank_plane_.emplace(view, rendering, engine::Gains{});
    if (stimuli_.size() == 1) plane_ = view.geometry;
    plane_.height_px = std::min(plane_.height_px, view.geometry.height_px);
    plane_.width_px = std::min(plane_.width_px, view.geometry.width_px);
  }
  if (stimuli_.empty()) {
    throw FileError(one_line(folder_ + ": the pack has no field; run `touchtrial prepare`"));
  }
}

void StimulusSource::fetch() const noexcept {
  for (const engine::MappedField& field : fields_) {
    read_pages(std::as_bytes(field.view().heights));
  }
}

const engine::RenderingModel& StimulusSource::model(const std::string& code) const {
  return stimulus(code).model;
}

engine::RenderingModel StimulusSource::model(const std::string& code, double gain_db) const {
  const Stimulus& found = stimulus(code);
  return {found.field, rendering_, engine::scaled_db(found.gains, gain_db)};
}

engine::FieldWithGains StimulusSource::field(const std::string& code) const {
  const Stimulus& found = stimulus(code);
  return {found.field, found.gains};
}

StimulusSource::Mix StimulusSource::mix_of(const study::Plane& plane) noexcept {
  if (!plane.mix || plane.mix->share == 0.0) return {plane.field, plane.field, 0.0};
  return {plane.field, plane.mix->other, plane.mix->share};
}

StimulusSource::StimulusSource(const engine::Pack& pack, const study::StudyCodes& codes)
    : StimulusSource(pack, codes.study.rendering) {
  for (const study::KeyedStimulus& keyed : codes.fields()) static_cast<void>(stimulus(keyed.code));
  // The blank plane always uses the field whose code sorts first.
  const auto first = std::ranges::min_element(codes.stimuli, {}, &study::KeyedStimulus::code);
  blank_plane_.emplace(stimulus(first->code).field, rendering_, engine::Gains{});
  const study::Fields fields = codes.study.task->fields(codes.study);
  if (!fields.has_equal_heights) return;
  for (const auto& [code, index] : codes.fields()) {
    const Mix unmixed{index, index, 0.0};
    mixes_.emplace(unmixed, apply_gains(unmixed, codes));
  }
  for (const study::Plane& plane : fields.mixtures) {
    const Mix mix = mix_of(plane);
    if (!mixes_.contains(mix)) mixes_.emplace(mix, apply_gains(mix, codes));
  }
}

StimulusSource::AppliedField StimulusSource::apply_gains(const Mix& mix,
                                                         const study::StudyCodes& codes) const {
  const Stimulus& first = stimulus(codes.code_of(mix.first));
  const std::array<engine::FieldWithGains, 1> unmixed = {{{first.field, first.gains}}};
  if (mix.share == 0.0) return {engine::sum_with_gains(unmixed), 1.0};
  const Stimulus& second = stimulus(codes.code_of(mix.second));
  const std::array<engine::FieldWithGains, 2> parts = {
      engine::FieldWithGains{first.field, engine::scaled(first.gains, 1.0 - mix.share)},
      engine::FieldWithGains{second.field, engine::scaled(second.gains, mix.share)}};
  AppliedField sum{engine::sum_with_gains(parts), 1.0};
  if (rendering_.equalise != engine::Equalise::rms) return sum;
  // The sum is scaled to the rms force of the first field, which is the same for all stimuli of the
  // study.
  const double target = engine::lateral_rms(engine::sum_with_gains(unmixed).view());
  const double mixed = engine::lateral_rms(sum.field.view());
  sum.factor = mixed > 0.0 ? target / mixed : 1.0;
  return sum;
}

engine::RenderingModel StimulusSource::equal_height_model(const study::Plane& plane) const {
  const auto found = mixes_.find(mix_of(plane));
  if (found == mixes_.end()) {
    throw std::logic_error("StimulusSource: the plane is not in Fields::mixtures of the task");
  }
  const double gain =
      plane.blank ? 0.0 : found->second.factor * std::pow(10.0, plane.gain_db / 20.0);
  engine::FieldView field = found->second.field.view();
  field.geometry.pitch_mm *= plane.pitch;
  return {field, rendering_, {gain, gain, gain}};
}

engine::RenderingModel StimulusSource::plane_of(const study::Plane& plane,
                                                const study::StudyCodes& codes) const {
  if (!mixes_.empty()) return equal_height_model(plane);
  if (plane.mix || plane.pitch != 1.0) {
    throw std::logic_error("StimulusSource: mixed or stretched planes must have equal heights");
  }
  if (plane.blank) return blank_plane();
  return model(codes.code_of(plane.field), plane.gain_db);
}

const StimulusSource::Stimulus& StimulusSource::stimulus(const std::string& code) const {
  const auto found = stimuli_.find(code);
  if (found == stimuli_.end()) {
    throw FileError(
        one_line(folder_ + ": the pack has no field " + code + "; run `touchtrial prepare`"));
  }
  return found->second;
}

}  // namespace touchtrial::session
