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

void touch(std::span<const std::byte> bytes) noexcept {
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
      throw FileError(one_line(folder_ + ": field " + entry.code +
                               " has another rendering model than the study; run `touchtrial "
                               "prepare`"));
    }
    stimuli_.emplace(entry.code, Stimulus{view, entry.gains,
                                          engine::RenderingModel(view, rendering, entry.gains)});
    // The blank plane is made from a field, so that its computation takes as long as that of
    // others.
    if (!flat_) flat_.emplace(view, rendering, engine::Gains{});
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
    touch(std::as_bytes(field.view().heights));
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
  // The blank plane always comes from the same field, that with the first code.
  const auto first = std::ranges::min_element(codes.stimuli, {}, &study::KeyedStimulus::code);
  flat_.emplace(stimulus(first->code).field, rendering_, engine::Gains{});
  const study::Fields fields = codes.study.task->fields(codes.study);
  if (!fields.levelled) return;
  for (const auto& [code, index] : codes.fields()) {
    const Mix alone{index, index, 0.0};
    mixes_.emplace(alone, applied(alone, codes));
  }
  for (const study::Plane& plane : fields.mixtures) {
    const Mix mix = mix_of(plane);
    if (!mixes_.contains(mix)) mixes_.emplace(mix, applied(mix, codes));
  }
}

StimulusSource::Applied StimulusSource::applied(const Mix& mix,
                                                const study::StudyCodes& codes) const {
  const Stimulus& one = stimulus(codes.code_of(mix.one));
  const std::array<engine::FieldWithGains, 1> alone = {{{one.field, one.gains}}};
  if (mix.share == 0.0) return {engine::applied_sum(alone), 1.0};
  const Stimulus& other = stimulus(codes.code_of(mix.other));
  const std::array<engine::FieldWithGains, 2> parts = {
      engine::FieldWithGains{one.field, engine::scaled(one.gains, 1.0 - mix.share)},
      engine::FieldWithGains{other.field, engine::scaled(other.gains, mix.share)}};
  Applied sum{engine::applied_sum(parts), 1.0};
  if (rendering_.equalise != engine::Equalise::rms) return sum;
  // Scaled to the rms force of the first field alone, which all stimuli of the study have.
  const double wanted = engine::lateral_rms(engine::applied_sum(alone).view());
  const double mixed = engine::lateral_rms(sum.field.view());
  sum.factor = mixed > 0.0 ? wanted / mixed : 1.0;
  return sum;
}

engine::RenderingModel StimulusSource::levelled(const study::Plane& plane) const {
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
  if (!mixes_.empty()) return levelled(plane);
  if (plane.mix || plane.pitch != 1.0) {
    throw std::logic_error("StimulusSource: planes that are mixed or stretched must be levelled");
  }
  if (plane.blank) return flat();
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
