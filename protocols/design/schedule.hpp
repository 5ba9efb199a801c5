/// \file What a participant gets, in which order: a function of the study and the enrolment number.
#pragma once

#include "protocols/design/study.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::design {

/// Indices into the study's classes, a class's images, and the study's methods.
struct StimulusIndex {
  int class_index = 0;
  int exemplar = 0;
  int method = 0;

  friend auto operator<=>(const StimulusIndex&, const StimulusIndex&) = default;
};

/// A catch trial presents a plane without texture: its `stimulus` means nothing.
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
  std::vector<int> layout;  ///< class index of the picture at each position

  friend bool operator==(const Schedule&, const Schedule&) = default;
};

/// The schedule of one participant. Depends on the study's seed, classes, methods and trial options
/// and on the enrolment number, and on nothing else: the same on every platform.
/// \param enrolment  from 1
/// \throws StudyError if the order is impossible for the study
[[nodiscard]] Schedule make_schedule(const Study& study, int enrolment);

/// A block of a participant's schedule once more, in a fresh order, with as many catch trials as it
/// had: a function of the arguments alone. What it was before tells nothing of it.
/// \param block  from 0  \param restarts_before  of this block by this participant, from 0
/// \param first_trial  number of its first presentation; the others follow
/// \throws StudyError if the order is impossible for the study
/// \throws std::invalid_argument if there is no such block
[[nodiscard]] std::vector<Presentation> restarted_block(const Study& study, int enrolment,
                                                        int block, int restarts_before,
                                                        int first_trial);

/// Method blocks in a carry-over-balanced order: row (enrolment mod rows) of a Williams design.
/// \param methods  >= 1
/// \return method indices, each once. For an odd number, rows from `methods` on are the mirror
/// images.
[[nodiscard]] std::vector<int> williams_row(int methods, int enrolment);

/// How many different rows there are. \param methods  >= 1
[[nodiscard]] int williams_rows(int methods);

/// Names this rule and its version; the seal commits to it.
[[nodiscard]] std::string schedule_rule(const Study& study);

}  // namespace touchtrial::design
