#include "app/sound/sound_accelerometer.hpp"

#include "app/sound/port_audio.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>

namespace touchtrial::app {
namespace {

constexpr double kLongestS = 30.0;
/// Of the range: conditioners limit a little below its end.
constexpr float kOverdriven = 0.99F;

}  // namespace

struct SoundAccelerometer::Input {
  Input(const std::string& name, std::vector<double> scales)
      : full_scale_m_s2(std::move(scales)),
        samples(static_cast<std::size_t>(kLongestS * kInputHz) * full_scale_m_s2.size()) {
    const QuietErrors quiet;
    library.emplace();
    stream =
        library->opened_input(name, static_cast<int>(full_scale_m_s2.size()), take, this, kInputHz);
  }
  ~Input() { library->close(stream); }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// On the sound card's thread.
  static int take(const void* input, void* /*output*/, unsigned long frames,
                  const PaStreamCallbackTimeInfo* /*times*/, PaStreamCallbackFlags flags,
                  void* data) {
    auto& own = *static_cast<Input*>(data);
    if ((flags & paInputOverflow) != 0) own.lost.store(true);
    const std::size_t at = own.taken.load();
    const std::size_t count =
        std::min<std::size_t>(frames * own.full_scale_m_s2.size(), own.samples.size() - at);
    if (input != nullptr) std::copy_n(static_cast<const float*>(input), count, &own.samples[at]);
    own.taken.store(at + count);
    return at + count < own.samples.size() ? paContinue : paComplete;
  }

  std::vector<double> full_scale_m_s2;
  std::vector<float> samples;
  std::atomic<std::size_t> taken{0};
  std::atomic<bool> lost{false};
  std::optional<PortAudio> library;
  PaStream* stream = nullptr;
};

SoundAccelerometer::SoundAccelerometer(const std::string& name,
                                       std::vector<double> full_scale_m_s2) {
  const bool is_positive = std::ranges::all_of(
      full_scale_m_s2, [](double scale) { return std::isfinite(scale) && scale > 0.0; });
  if (!is_positive || (full_scale_m_s2.size() != 1 && full_scale_m_s2.size() != 3)) {
    throw UsageError(
        "--full-scale: give the acceleration in m/s2 at the end of the input's range, above 0: one "
        "number for one axis, or three for x,y,z");
  }
  input_ = std::make_unique<Input>(name, std::move(full_scale_m_s2));
}

SoundAccelerometer::~SoundAccelerometer() = default;

void SoundAccelerometer::start() {
  // Until it is started, nobody else touches the samples.
  input_->taken.store(0);
  input_->lost.store(false);
  input_->library->start(input_->stream);
}

device::AccelerometerRecord SoundAccelerometer::stop() {
  const bool went_on =
      input_->library->is_active(input_->stream) || input_->taken.load() == input_->samples.size();
  input_->library->stop(input_->stream);
  if (!went_on || input_->lost.load()) {
    throw DeviceError(
        "sound: the input lost samples or is gone; close other programs, check its cable, and "
        "begin the acceptance again");
  }
  return record_of_sound(
      {input_->samples.begin(),
       input_->samples.begin() + static_cast<std::ptrdiff_t>(input_->taken.load())},
      input_->full_scale_m_s2);
}

device::AccelerometerRecord record_of_sound(const std::vector<float>& samples,
                                            const std::vector<double>& full_scale_m_s2) {
  const std::size_t channels = full_scale_m_s2.size();
  device::AccelerometerRecord record{SoundAccelerometer::kRateHz, {}, false};
  const std::size_t frame = channels * SoundAccelerometer::kMeanOf;
  for (std::size_t at = 0; at + frame <= samples.size(); at += frame) {
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < frame; ++i) {
      const float sample = samples[at + i];
      if (!(std::abs(sample) < kOverdriven)) record.overdriven = true;
      sum[i % channels] += static_cast<double>(sample);
    }
    for (std::size_t c = 0; c < channels; ++c) {
      sum[c] *= full_scale_m_s2[c] / SoundAccelerometer::kMeanOf;
    }
    record.acceleration_m_s2.push_back({sum[0], sum[1], sum[2]});
  }
  return record;
}

}  // namespace touchtrial::app
