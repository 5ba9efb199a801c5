/// \file Sounds that a participant's window asks for.
#pragma once

namespace touchtrial::app {

enum class Cue {
  plane_on,   ///< the plane can be touched
  plane_off,  ///< it no longer can: an answer is due
  too_hard,   ///< more force than is good for hand and device
};

/// Whoever has a loudspeaker.
class Cues {
 public:
  virtual ~Cues() = default;
  /// Begins to sound and returns at once. Any thread but the servo's; never waits.
  virtual void tone(Cue cue) noexcept = 0;
};

}  // namespace touchtrial::app
