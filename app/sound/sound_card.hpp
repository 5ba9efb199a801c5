/// \file The computer's loudspeaker or headphones.
#pragma once

#include "app/sound/sound_mixer.hpp"

#include <memory>

namespace touchtrial::app {

/// Plays a mixer on the system's usual output (PortAudio), both ears alike. Made and destroyed on
/// one thread; the mixer is rendered on the sound card's own.
class SoundCard {
 public:
  static constexpr double kRateHz = 48000.0;

  /// Begins to play. \param mixer  for kRateHz; must outlive this
  /// \throws DeviceError with the remedy if there is no output, or it cannot be opened
  explicit SoundCard(SoundMixer& mixer);
  ~SoundCard();
  SoundCard(const SoundCard&) = delete;
  SoundCard& operator=(const SoundCard&) = delete;

  /// Whether samples are still being taken. Not for the sound card's thread.
  [[nodiscard]] bool plays() const noexcept;

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

}  // namespace touchtrial::app
