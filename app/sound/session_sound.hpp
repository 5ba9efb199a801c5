/// \file The sound of a session on the computer's loudspeaker or headphones, and the record of it.
#pragma once

#include "app/participant/cues.hpp"
#include "app/sound/sound_mixer.hpp"
#include "protocols/design/session_plan.hpp"
#include "protocols/session/experimenter.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace touchtrial::app {

/// Plays a mixer on the system's default output (PortAudio), equally on both ears. Belongs to one
/// thread; the mixer renders on the sound card's own thread.
class SoundCard {
 public:
  static constexpr double kRateHz = 48000.0;

  /// Begins to play.
  /// \param mixer  for kRateHz; must outlive this
  /// \throws DeviceError with the remedy if there is no output, or it cannot be opened
  explicit SoundCard(SoundMixer& mixer);
  ~SoundCard();
  SoundCard(const SoundCard&) = delete;
  SoundCard& operator=(const SoundCard&) = delete;

  /// Whether the output still plays. Not for the sound card's thread.
  [[nodiscard]] bool plays() const noexcept;

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

/// Masking noise for the whole session, and tones. Without a sound output, the session continues in
/// silence, which is recorded once.
class SessionSound final : public Cues {
 public:
  /// Begins the noise if the plan wants it.
  /// \param seed  seed of the noise
  SessionSound(const design::MaskingPlan& plan, std::uint64_t seed);

  void tone(Cue cue) noexcept override;

  /// Why there is no sound, with the remedy; empty if there is sound.
  [[nodiscard]] const std::string& trouble() const noexcept { return trouble_; }
  /// The next entry for the session's record, each once: the level of the noise as a note, or the
  /// deviation "no-masking-noise". Call several times per second, on one thread.
  [[nodiscard]] std::optional<session::ExperimenterRequest> to_record();

 private:
  design::MaskingPlan plan_;
  SoundMixer mixer_;
  std::optional<SoundCard> card_;
  std::string trouble_;
  bool recorded_ = false;
  bool loss_recorded_ = false;
};

}  // namespace touchtrial::app
