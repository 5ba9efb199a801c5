/// \file What a participant is presented, in which order.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::design {

struct Study;

/// Indices into the study's classes, a class's images, and the study's methods.
struct StimulusIndex {
  int class_index = 0;
  int exemplar = 0;
  int method = 0;

  friend auto operator<=>(const StimulusIndex&, const StimulusIndex&) = default;
};

/// A catch trial presents a plane without texture: its `stimulus` has no meaning.
enum class PresentationKind { scored, lead_in, catch_trial };

struct Presentation {
  int trial = 0;  ///< from 1
  int block = 0;  ///< from 0
  PresentationKind kind = PresentationKind::scored;
  StimulusIndex stimulus;

  friend bool operator==(const Presentation&, const Presentation&) = default;
};

struct Schedule {
  std::vector<Presentation> presentations;
  /// The choice at each position of the answer screen: an index into the protocol's choices.
  std::vector<int> layout;

  friend bool operator==(const Schedule&, const Schedule&) = default;
};

/// The schedule of one participant, as the study's protocol makes it: a function of the study's
/// seed, classes, methods and trial options and of the enrolment number alone, equal on every
/// platform.
/// \param enrolment  from 1
/// \throws StudyError if the order is impossible for the study
[[nodiscard]] Schedule make_schedule(const Study& study, int enrolment);

/// A block of a participant's schedule in a fresh order, with as many catch trials as before: a
/// function of the arguments alone. The new order tells nothing about the old one.
/// \param block  from 0
/// \param restarts_before  of this block by this participant, from 0
/// \param first_trial  the number of the block's first presentation; the others follow
/// \throws StudyError if the order is impossible for the study
/// \throws std::invalid_argument if there is no such block
[[nodiscard]] std::vector<Presentation> restarted_block(const Study& study, int enrolment,
                                                        int block, int restarts_before,
                                                        int first_trial);

/// The name and version of the rule that makes schedules; the seal commits to it.
[[nodiscard]] std::string schedule_rule(const Study& study);

}  // namespace touchtrial::design
