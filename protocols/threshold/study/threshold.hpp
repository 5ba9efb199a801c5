/// \file The protocol "threshold", which measures detection and discrimination thresholds. A
/// participant explores two or three planes and chooses one, or reports whether they are the same.
/// Source: docs/thresholds.md.
#pragma once

#include "protocols/procedures/tracks.hpp"
#include "study/protocol.hpp"
#include "study/study.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::study::threshold {

enum class Task {
  detection,      ///< of a texture against the same wall without it
  discrimination  ///< of a comparison from a standard
};

enum class Question {
  which_interval,  ///< which plane had the texture, or was stronger or coarser
  odd_one_out,     ///< which of three planes differs from the other two
  same_different   ///< whether two planes are the same
};

/// The quantity that varies with the level.
enum class LevelQuantity {
  gain,   ///< gain of the texture's forces
  pitch,  ///< millimetres per pixel
  order,  ///< order of differentiation of the method `fixed`
  blend   ///< share of the second of two textures
};

/// The standard of one or several tracks.
struct Standard {
  int class_index = 0;
  /// Detection, pitch and blend: 0. Gain: dB re the pack's gain. Order: the standard's order.
  double value = 0.0;
};

/// The section "threshold" of the study file.
struct ThresholdOptions {
  Task task = Task::detection;
  Question question = Question::which_interval;
  LevelQuantity along = LevelQuantity::gain;
  int intervals = 2;        ///< 2 or 3; odd_one_out 3, same_different 2
  double interval_s = 2.5;  ///< TimedContact::seconds
  HandRange windows{};
  /// Settings common to all tracks, with the study's levels. Detection: dB re the pack's gain, at
  /// most 0. Discrimination: 20 log10(dA / A), where A is the standard's amplitude, pitch or order;
  /// for a blend, dA is the share and A = 1.
  procedures::TrackSettings track{};
  std::vector<double> standards{};  ///< for discrimination along gain and order; otherwise {0}
  int tracks_each = 1;              ///< tracks per class and standard; at most 8 tracks in total
  int catch_trials = 0;             ///< number over all tracks, see procedures::BlockSettings
  double rove_db = 0.0;  ///< range from which each interval's gain is drawn; 0: not roved
  bool feedback = false;
  int practice_trials = 0;     ///< per round, at the highest level
  int practice_criterion = 0;  ///< right answers in a round that end practice
  int practice_rounds = 2;     ///< maximum number of rounds
  int control_trials = 0;      ///< at the end, with the hand off the device
};

/// \pre the study's protocol is "threshold"
[[nodiscard]] const ThresholdOptions& options_of(const Study& study);
/// A copy of the study with other options. Does not check them.
[[nodiscard]] Study with_options(const Study& study, const ThresholdOptions& options);

/// The protocol "threshold".
[[nodiscard]] const Protocol& protocol();

[[nodiscard]] std::string_view name_of(Task task);
[[nodiscard]] std::string_view name_of(Question question);
[[nodiscard]] std::string_view name_of(LevelQuantity along);
[[nodiscard]] std::string_view name_of(procedures::Shape shape);

/// The standards by class and value. Track t, from 0, has the standard t / tracks_each.
[[nodiscard]] std::vector<Standard> standards_of(const Study& study);
/// \return for example "bark", "bark, standard -12 dB", "bark, order 0.5", "bark to cloth"
[[nodiscard]] std::string words_of(const Study& study, const Standard& standard);

/// The plane at a level, before exemplars are chosen and gains are roved.
/// \param standard_index  index into standards_of
/// \param level  index into the levels; empty: the standard, or the blank plane
[[nodiscard]] Plane plane_at(const Study& study, std::size_t standard_index,
                             std::optional<std::size_t> level);

/// The levels of a standard's tracks: all levels whose comparisons do not exceed the pack's gain.
[[nodiscard]] std::vector<double> levels_of(const ThresholdOptions& options,
                                            const Standard& standard);

/// All tracks of a participant, to be interleaved. Each has its standard's levels.
[[nodiscard]] procedures::BlockSettings block_settings(const Study& study);
/// The secret of one participant's procedures::Block.
[[nodiscard]] Digest block_secret(const ScheduleDraw& draw);

/// The number of missing catch trials. A track needs a tenth of its trials, at least six but at
/// most half, at the highest level, where only lapses cause wrong answers. Without them a lapse
/// looks like a higher threshold.
/// \return 0 for the question same_different, which gives no thresholds
[[nodiscard]] int missing_catch_trials(const Study& study);

/// The comparison's quantity at a level: A + dA, in the units of Standard::value; for detection,
/// the level.
[[nodiscard]] double comparison_at(const ThresholdOptions& options, const Standard& standard,
                                   double level);

/// The unit of levels, for messages and reports.
[[nodiscard]] std::string unit_of_level(const ThresholdOptions& options);

}  // namespace touchtrial::study::threshold
