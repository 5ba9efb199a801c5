/// \file Sounds requested by the participant's window; app/sound plays them.
#pragma once

namespace touchtrial::app {

enum class Cue {
  plane_on,   ///< the plane can be touched
  plane_off,  ///< the plane is off: an answer is due
  too_hard,   ///< too much force for hand and device
  stopped,    ///< a comfort stop: the force is off
  // In a trial with several planes:
  first_begins,  ///< the first can be touched
  second_begins,
  third_begins,
  interval_over,
};

/// Plays cues.
class Cues {
 public:
  virtual ~Cues() = default;
  /// Starts the sound and returns at once. Any thread except the servo's may call it.
  virtual void play(Cue cue) noexcept = 0;
};

}  // namespace touchtrial::app
