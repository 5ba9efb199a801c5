#include "app/sound/session_sound.hpp"

#include "app/sound/port_audio.hpp"
#include "core/errors.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <portaudio.h>

namespace touchtrial::app {
namespace {

constexpr int kOctaves = 16;
constexpr std::size_t kSamples = std::size_t{1} << 18;

/// The sum of all rows of random steps; the slowest row has four steps per loop.
std::vector<double> sum_of_steps(RandomStream& random) {
  std::vector<double> sum(kSamples);
  for (int octave = 0; octave <= kOctaves; ++octave) {
    const std::size_t step_length = std::size_t{1} << octave;
    for (std::size_t begin = 0; begin < kSamples; begin += step_length) {
      const double step = random.uniform(-1.0, 1.0);
      for (std::size_t i = begin; i < begin + step_length; ++i) sum[i] += step;
    }
  }
  return sum;
}

/// Three tones, or one of them and an interval's mark, stay within full scale together with the
/// loudest noise; more would be clipped.
constexpr double kToneAmplitude = 0.06;
constexpr Cue kCues[] = {Cue::plane_on,     Cue::plane_off,    Cue::too_hard,
                         Cue::stopped,      Cue::first_begins, Cue::second_begins,
                         Cue::third_begins, Cue::interval_over};
// The marks of intervals.
constexpr double kMarkHz = 1000.0;
constexpr double kPipS = 0.12;
constexpr double kPipGapS = 0.12;
constexpr double kLongMarkS = 0.45;
constexpr double kToneRampS = 0.01;

/// Adds a glide from one frequency to another, with a ramp at each end.
void add_tone(std::vector<float>& samples, double rate_hz, double start_hz, double end_hz,
              double seconds, double amplitude = kToneAmplitude) {
  const auto count = static_cast<std::size_t>(std::lround(seconds * rate_hz));
  const auto ramp = std::lround(kToneRampS * rate_hz);
  double cycles = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto edge_distance = static_cast<double>(std::min(i, count - 1 - i));
    const double rise = std::min(1.0, edge_distance / static_cast<double>(ramp));
    const double envelope = 0.5 - 0.5 * std::cos(std::numbers::pi * rise);
    samples.push_back(
        static_cast<float>(amplitude * envelope * std::sin(2.0 * std::numbers::pi * cycles)));
    const double progress = static_cast<double>(i) / static_cast<double>(count);
    cycles += (start_hz + (end_hz - start_hz) * progress) / rate_hz;
  }
}

void add_silence(std::vector<float>& samples, double rate_hz, double seconds) {
  samples.resize(samples.size() + static_cast<std::size_t>(std::lround(seconds * rate_hz)));
}

/// Adds short pips that count up to the number of an interval.
void add_pips(std::vector<float>& samples, double rate_hz, int count) {
  for (int i = 0; i < count; ++i) {
    if (i > 0) add_silence(samples, rate_hz, kPipGapS);
    add_tone(samples, rate_hz, kMarkHz, kMarkHz, kPipS, kMarkAmplitude);
  }
}

/// The samples of a cue. Cues differ in contour, not only in pitch.
std::vector<float> tone_of(Cue cue, double rate_hz) {
  std::vector<float> samples;
  switch (cue) {
    case Cue::plane_on:
      add_tone(samples, rate_hz, 500.0, 1000.0, 0.3);
      break;
    case Cue::plane_off:
      add_tone(samples, rate_hz, 660.0, 660.0, 0.12);
      add_silence(samples, rate_hz, 0.1);
      add_tone(samples, rate_hz, 660.0, 660.0, 0.12);
      break;
    case Cue::too_hard:
      add_tone(samples, rate_hz, 300.0, 300.0, 0.25);
      break;
    case Cue::stopped:
      add_tone(samples, rate_hz, 800.0, 400.0, 0.5);
      break;
    case Cue::first_begins:
      add_pips(samples, rate_hz, 1);
      break;
    case Cue::second_begins:
      add_pips(samples, rate_hz, 2);
      break;
    case Cue::third_begins:
      add_pips(samples, rate_hz, 3);
      break;
    case Cue::interval_over:
      add_tone(samples, rate_hz, kMarkHz, kMarkHz, kLongMarkS, kMarkAmplitude);
      break;
  }
  return samples;
}

}  // namespace

std::vector<float> masking_noise(double level_dbfs, std::uint64_t seed) {
  RandomStream random(seed, "masking noise");
  const std::vector<double> sum = sum_of_steps(random);
  double mean = 0.0;
  for (const double value : sum) mean += value;
  mean /= static_cast<double>(kSamples);
  double power = 0.0;
  for (const double value : sum) power += (value - mean) * (value - mean);
  const double rms = std::sqrt(power / static_cast<double>(kSamples));
  const double target_rms = std::pow(10.0, std::min(level_dbfs, kMaxMaskingDbfs) / 20.0);
  std::vector<float> noise(kSamples);
  for (std::size_t i = 0; i < kSamples; ++i) {
    noise[i] = static_cast<float>((sum[i] - mean) * target_rms / rms);
  }
  return noise;
}

SoundMixer::SoundMixer(double sample_rate_hz, std::vector<float> noise)
    : noise_(std::move(noise)), gain_step_(static_cast<float>(1.0 / (kRampS * sample_rate_hz))) {
  for (const Cue cue : kCues) {
    Voice& voice = voices_[static_cast<std::size_t>(cue)];
    voice.tone = tone_of(cue, sample_rate_hz);
    voice.position = voice.tone.size();
  }
}

void SoundMixer::play(Cue cue) noexcept {
  voices_[static_cast<std::size_t>(cue)].is_requested.store(true);
}

float SoundMixer::next_noise() noexcept {
  if (noise_.empty()) return 0.0F;
  const float target = is_masking_.load(std::memory_order_relaxed) ? 1.0F : 0.0F;
  gain_ = std::clamp(target, gain_ - gain_step_, gain_ + gain_step_);
  const float sample = gain_ * noise_[noise_position_];
  noise_position_ = noise_position_ + 1 == noise_.size() ? 0 : noise_position_ + 1;
  return sample;
}

void SoundMixer::render(std::span<float> samples) noexcept {
  for (Voice& voice : voices_) {
    const bool is_requested = voice.is_requested.exchange(false);
    if (is_requested && voice.position == voice.tone.size()) voice.position = 0;
  }
  for (float& sample : samples) {
    float sum = next_noise();
    for (Voice& voice : voices_) {
      if (voice.position < voice.tone.size()) sum += voice.tone[voice.position++];
    }
    sample = std::clamp(sum, -1.0F, 1.0F);
  }
  rendered_.fetch_add(static_cast<std::int64_t>(samples.size()));
}

namespace {

int render_callback(const void* /*input*/, void* output, unsigned long frames,
                    const PaStreamCallbackTimeInfo* /*times*/, PaStreamCallbackFlags /*flags*/,
                    void* mixer) {
  static_cast<SoundMixer*>(mixer)->render({static_cast<float*>(output), frames});
  return paContinue;
}

session::ExperimenterRequest no_masking_entry(const std::string& reason) {
  return {session::ExperimenterRequest::Kind::deviation, reason, "no-masking-noise"};
}

}  // namespace

struct SoundCard::Stream {
  explicit Stream(SoundMixer& mixer)
      : stream(library.open_default_output(render_callback, &mixer, kRateHz)) {
    library.start(stream);
  }
  ~Stream() { library.close(stream); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  PortAudio library;
  PaStream* stream;
};

SoundCard::SoundCard(SoundMixer& mixer) {
  const QuietErrors quiet;
  stream_ = std::make_unique<Stream>(mixer);
}

SoundCard::~SoundCard() = default;

bool SoundCard::is_playing() const noexcept {
  return stream_->library.is_active(stream_->stream);
}

SessionSound::SessionSound(const study::MaskingPlan& plan, std::uint64_t seed)
    : plan_(plan),
      mixer_(SoundCard::kRateHz,
             plan.wanted ? masking_noise(plan.level_dbfs, seed) : std::vector<float>{}) {
  mixer_.set_masking(plan.wanted);
  try {
    card_.emplace(mixer_);
  } catch (const DeviceError& error) {
    failure_reason_ = error.what();
  }
}

void SessionSound::play(Cue cue) noexcept {
  mixer_.play(cue);
}

std::optional<session::ExperimenterRequest> SessionSound::next_record_entry() {
  if (!plan_.wanted) return std::nullopt;
  if (!is_recorded_) {
    is_recorded_ = true;
    if (!card_) return no_masking_entry(failure_reason_);
    return session::ExperimenterRequest{session::ExperimenterRequest::Kind::note,
                                        fmt::format("masking noise at {:.1f} dBFS rms",
                                                    std::min(plan_.level_dbfs, kMaxMaskingDbfs)),
                                        ""};
  }
  if (!card_ || is_loss_recorded_ || card_->is_playing()) return std::nullopt;
  is_loss_recorded_ = true;
  failure_reason_ =
      "sound: the output was lost; connect the headphones again before the next session";
  return no_masking_entry(failure_reason_);
}

}  // namespace touchtrial::app
