/// \file The sound of a session on the computer's loudspeaker or headphones: masking noise and
///   tones, their samples, and their record.
#pragma once

#include "app/windows/participant/cues.hpp"
#include "protocols/session/experimenter.hpp"
#include "study/session_plan.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::app {

/// The highest level of the noise. Above it, peaks of the noise and tones could exceed the range of
/// the sound card.
inline constexpr double kMaxMaskingDbfs = -18.0;

/// A seamless loop of pink noise (equal power in every octave) that covers the sound of a device.
/// It is a sum of random steps, one row for each octave, each half as fast as the previous one.
/// Source: the method of Voss and McCartney; Gardner, Scientific American 238(4), 1978.
/// \param level_dbfs  exact rms in dB relative to full scale, at most kMaxMaskingDbfs
/// \param seed  determines every sample
/// \return 2^18 samples, 5.5 s at 48 kHz, with mean 0; |sample| < 0.8
[[nodiscard]] std::vector<float> masking_noise(double level_dbfs, std::uint64_t seed);

/// The peak of the tones that mark intervals; twice that of the other tones, because trials depend
/// on them. Each is a pure tone of 1 kHz at -21.4 dBFS rms: 8.6 dB above the total noise at its
/// default level of -30 dBFS, and 13 dB above the loudest noise in the one-third-octave band around
/// 1 kHz (25 dB at the default level).
inline constexpr double kMarkAmplitude = 0.12;

/// One channel. `render` belongs to the sound card's thread; the other functions may be called on
/// any thread. Neither blocks the other. Noise and tones begin and end in ramps, to avoid clicks.
class SoundMixer {
 public:
  static constexpr double kRampS = 0.05;  ///< duration of the noise's ramp

  /// \param sample_rate_hz  rate of the sound card, 8000 to 192000
  /// \param noise  a loop with |sample| < 0.8; may be empty
  SoundMixer(double sample_rate_hz, std::vector<float> noise);

  void set_masking(bool is_on) noexcept { is_masking_.store(is_on); }
  /// Plays a tone, unless it is still playing.
  void play(Cue cue) noexcept;
  /// Writes the next samples, each in [-1, 1]. Allocates and locks nothing.
  void render(std::span<float> samples) noexcept;
  /// Samples rendered so far.
  [[nodiscard]] std::int64_t rendered_samples() const noexcept { return rendered_.load(); }

 private:
  struct Voice {
    std::vector<float> tone;
    std::atomic<bool> is_requested{false};
    std::size_t position = 0;  ///< the next sample; silent at the tone's size
  };
  [[nodiscard]] float next_noise() noexcept;

  std::vector<float> noise_;
  std::size_t noise_position_ = 0;
  float gain_ = 0.0F;
  float gain_step_;
  std::atomic<bool> is_masking_{false};
  std::array<Voice, 8> voices_;
  std::atomic<std::int64_t> rendered_{0};
};

/// Plays a mixer on the system's default output (PortAudio), with the same sound on both channels.
/// Belongs to one thread; the mixer renders on the sound card's own thread.
class SoundCard {
 public:
  static constexpr double kRateHz = 48000.0;

  /// Starts playing.
  /// \param mixer  a mixer for kRateHz; must outlive this
  /// \throws DeviceError with the remedy if there is no output, or it cannot be opened
  explicit SoundCard(SoundMixer& mixer);
  ~SoundCard();
  SoundCard(const SoundCard&) = delete;
  SoundCard& operator=(const SoundCard&) = delete;

  /// Whether the output is still playing. Not for the sound card's thread.
  [[nodiscard]] bool is_playing() const noexcept;

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

/// Masking noise for the whole session, and tones. Without a sound output, the session continues in
/// silence, which is recorded once.
class SessionSound final : public Cues {
 public:
  /// Starts the noise if the study plans it.
  /// \param seed  seed of the noise
  SessionSound(const study::MaskingPlan& plan, std::uint64_t seed);

  void play(Cue cue) noexcept override;

  /// Why there is no sound, with the remedy; empty if there is sound.
  [[nodiscard]] const std::string& failure_reason() const noexcept { return failure_reason_; }
  /// The next entry for the session's record, each once: the level of the noise as a note, or the
  /// deviation "no-masking-noise". Call several times per second, on one thread.
  [[nodiscard]] std::optional<session::ExperimenterRequest> next_record_entry();

 private:
  study::MaskingPlan plan_;
  SoundMixer mixer_;
  std::optional<SoundCard> card_;
  std::string failure_reason_;
  bool is_recorded_ = false;
  bool is_loss_recorded_ = false;
};

}  // namespace touchtrial::app
