/// \file Thresholds: how weak a texture may be and still be felt, and how small a difference. A
/// participant explores two or three planes and names one, or says whether they are alike. Source:
/// docs/thresholds.md.
#pragma once

#include "protocols/procedures/tracks.hpp"
#include "study/protocol.hpp"
#include "study/study.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::study::threshold {

enum class Task {
  detection,      ///< a texture, or the same wall without it
  discrimination  ///< a standard, or a comparison that differs from it
};

enum class Question {
  which_interval,  ///< had the texture, was stronger, was coarser
  odd_one_out,     ///< of three: one is unlike the other two
  same_different   ///< two that are alike, or not
};

/// The quantity that levels are about.
enum class Along {
  gain,   ///< of the texture's forces
  pitch,  ///< millimetres a pixel
  order,  ///< of differentiation, of the method `fixed`
  blend   ///< share of the second of two textures
};

/// What one or several tracks are about.
struct Standard {
  int class_index = 0;
  /// Detection, pitch and blend: 0. Gain: dB re the pack's gain. Order: the standard's order.
  double value = 0.0;
};

/// The study file's "threshold".
struct ThresholdOptions {
  Task task = Task::detection;
  Question question = Question::which_interval;
  Along along = Along::gain;
  int intervals = 2;        ///< 2 or 3; odd_one_out 3, same_different 2
  double interval_s = 2.5;  ///< InContact::seconds
  HandRange windows{};
  /// Of every track, with the levels of all. Detection: dB re the pack's gain, at most 0.
  /// Discrimination: 20 log10(dA / A), A being the standard's amplitude, pitch or order; of a
  /// blend, dA the share and A = 1.
  procedures::TrackSettings track{};
  std::vector<double> standards{};  ///< of discrimination along gain and order, else {0}
  int tracks_each = 1;              ///< of each class and standard, 1 to 8 in all
  int catch_trials = 0;             ///< of all tracks: procedures::BlockSettings
  double rove_db = 0.0;             ///< each interval's gain is drawn from a range so wide, 0: not
  bool feedback = false;
  int practice_trials = 0;  ///< of a round, at the highest level
  int practice_criterion = 0;
  int practice_rounds = 2;
  int control_trials = 0;  ///< at the end, with the hand off the device
};

/// \pre the study's protocol is this one
[[nodiscard]] const ThresholdOptions& options_of(const Study& study);
/// The study with other options, which are not checked.
[[nodiscard]] Study with_options(const Study& study, const ThresholdOptions& options);

/// The protocol "threshold".
[[nodiscard]] const Protocol& protocol();

[[nodiscard]] std::string_view name_of(Task task);
[[nodiscard]] std::string_view name_of(Question question);
[[nodiscard]] std::string_view name_of(Along along);
[[nodiscard]] std::string_view name_of(procedures::Shape shape);

/// By class, then by standard: what track t, from 0, is about is at t / tracks_each.
[[nodiscard]] std::vector<Standard> standards_of(const Study& study);
/// \return for instance "bark", "bark, standard -12 dB", "bark, order 0.5", "bark to cloth"
[[nodiscard]] std::string words_of(const Study& study, const Standard& standard);

/// The plane of a level, before exemplars are chosen and gains roved.
/// \param nth_standard  index into standards_of
/// \param level  index into the levels; nothing: the standard, or the blank plane
[[nodiscard]] Plane plane_at(const Study& study, std::size_t nth_standard,
                             std::optional<std::size_t> level);

/// The levels of a standard's tracks: of all levels, from the lowest, those whose comparisons do
/// not exceed the pack's gain.
[[nodiscard]] std::vector<double> levels_of(const ThresholdOptions& options,
                                            const Standard& standard);

/// All tracks of a participant, interleaved. Each has its standard's levels.
[[nodiscard]] procedures::BlockSettings block_settings(const Study& study);
/// Of one participant: what Block is made from.
[[nodiscard]] Digest block_secret(const ScheduleDraw& draw);

/// The catch trials that the study lacks for a tenth of each track's trials, and six or more, to be
/// at the highest level, where only lapses make answers wrong: without them a lapse looks like a
/// higher threshold. A short track needs half of its trials at most.
/// \return 0 for same or different, which has no thresholds
[[nodiscard]] int missing_catch_trials(const Study& study);

/// The quantity of the comparison at a level: A + dA, in the units of Standard::value; of detection
/// the level itself.
[[nodiscard]] double comparison_at(const ThresholdOptions& options, const Standard& standard,
                                   double level);

/// A shape's parameters by name, for messages and reports: "dB" or "dB of the difference".
[[nodiscard]] std::string unit_of_level(const ThresholdOptions& options);

}  // namespace touchtrial::study::threshold
