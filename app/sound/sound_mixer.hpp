/// \file What the loudspeaker gets: masking noise and tones, sample by sample.
#pragma once

#include "app/participant/cues.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace touchtrial::app {

/// One channel. `render` belongs to the sound card's thread; everything else may be called on any.
/// Neither waits for the other. Everything begins and ends in ramps, so that nothing clicks.
class SoundMixer {
 public:
  static constexpr double kRampS = 0.05;  ///< of the noise, from silence to its level

  /// \param sample_rate_hz  of the sound card, 8000 to 192000
  /// \param noise  a loop with |sample| < 0.8; may be empty
  SoundMixer(double sample_rate_hz, std::vector<float> noise);

  void mask(bool on) noexcept { masks_.store(on); }
  /// A tone that still sounds is not begun anew.
  void tone(Cue cue) noexcept;
  /// The next samples, each in [-1, 1]. Allocates and locks nothing.
  void render(std::span<float> samples) noexcept;
  /// Samples rendered so far.
  [[nodiscard]] std::int64_t rendered() const noexcept { return rendered_.load(); }

 private:
  struct Voice {
    std::vector<float> tone;
    std::atomic<bool> asked{false};
    std::size_t at = 0;  ///< next sample; the tone's size: silent
  };
  [[nodiscard]] float next_noise() noexcept;

  std::vector<float> noise_;
  std::size_t noise_at_ = 0;
  float gain_ = 0.0F;
  float gain_step_;
  std::atomic<bool> masks_{false};
  std::array<Voice, 3> voices_;
  std::atomic<std::int64_t> rendered_{0};
};

}  // namespace touchtrial::app
