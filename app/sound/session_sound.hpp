/// \file All that a session sounds like, and what is written down about it.
#pragma once

#include "app/participant/cues.hpp"
#include "app/sound/sound_card.hpp"
#include "app/sound/sound_mixer.hpp"
#include "protocols/design/session_plan.hpp"
#include "protocols/session/experimenter.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace touchtrial::app {

/// Masking noise for the whole session and tones. A machine without sound is silent: that is said
/// once and recorded, and the session goes on.
class SessionSound final : public Cues {
 public:
  /// Begins the noise, if it is wanted. \param seed  of the noise
  SessionSound(const design::MaskingPlan& plan, std::uint64_t seed);

  void tone(Cue cue) noexcept override;

  /// Why nothing sounds, with the remedy; empty: it does.
  [[nodiscard]] const std::string& trouble() const noexcept { return trouble_; }
  /// What the session's record is to have, each once: the level of the noise as a note, or the
  /// deviation "no-masking-noise". Ask several times a second; one thread.
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
