/// \file The presentations of one participant and their order.
#pragma once

#include "core/cipher.hpp"
#include "core/random.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::study {

struct Study;

/// Indices into the study's classes, a class's images, and the study's methods.
struct StimulusIndex {
  int class_index = 0;
  int exemplar = 0;
  int method = 0;

  friend auto operator<=>(const StimulusIndex&, const StimulusIndex&) = default;
};

/// What a trial is for.
enum class Role {
  scored,
  lead_in,      ///< begins a block, and is not scored
  catch_trial,  ///< shows whether the participant attends; the `stimulus` has no meaning
  control,      ///< without the hand: whether the answer can be heard
};

/// "scored", "lead-in", "catch" or "control"
[[nodiscard]] std::string_view name_of(Role role);

/// What an adaptive order chose for a presentation.
struct ChosenLevel {
  int track = 0;   ///< from 1; 0: a catch trial, which belongs to no track
  int level = 0;   ///< index into the track's levels
  int target = 0;  ///< index of the right choice

  friend bool operator==(const ChosenLevel&, const ChosenLevel&) = default;
};

/// One of the planes that a trial presents one after the other.
struct Interval {
  StimulusIndex stimulus;
  bool blank = false;         ///< the wall of the stimulus without its texture
  double gain_db = 0.0;       ///< re the pack's gain of the stimulus
  double pitch_factor = 1.0;  ///< of the texture's millimetres a pixel, >= 1
  /// A texture that is mixed in, and its share, 0 .. 1.
  std::optional<StimulusIndex> other{};
  double share = 0.0;

  friend bool operator==(const Interval&, const Interval&) = default;
};

struct Presentation {
  int trial = 0;          ///< from 1
  int block = 0;          ///< from 0
  int interruptions = 0;  ///< of this trial so far, in a session
  Role role = Role::scored;
  StimulusIndex stimulus;  ///< with intervals: without meaning
  double gain_db = 0.0;    ///< re the pack's gain of the stimulus; with intervals: without meaning
  /// Nothing: the schedule says what is presented, or the order has not chosen yet.
  std::optional<ChosenLevel> chosen{};
  /// Empty: one plane, which is explored for as long as the participant wants.
  std::vector<Interval> intervals{};
  bool hand_off = false;  ///< the device moves by itself, and is only heard: of a control

  friend bool operator==(const Presentation&, const Presentation&) = default;
};

struct Schedule {
  std::vector<Presentation> presentations;
  /// The choice at each position of the answer screen, as an index into the protocol's choices.
  std::vector<int> layout;

  friend bool operator==(const Schedule&, const Schedule&) = default;
};

/// What one participant's schedule is drawn from. See draw_for in study/station.hpp.
struct ScheduleDraw {
  SecretKey secret{};    ///< this participant's alone
  int method_order = 0;  ///< row of the Williams design of methods, from 0
  /// Of a study that divides its methods between visits: whose methods, from 1; 0: all visits'.
  int visit = 0;
};

/// Makes the schedule of one participant with the study's protocol. It depends only on the study's
/// classes, methods and trial options and on the draw, and is the same on every platform.
/// \throws StudyError if the order is impossible for the study
[[nodiscard]] Schedule make_schedule(const Study& study, const ScheduleDraw& draw);

/// Makes a block of a participant's schedule in a fresh order, with as many catch trials as before.
/// It depends only on the arguments. The new order reveals nothing about the old one.
/// \param block  from 0
/// \param restarts_before  earlier restarts of this block for this participant, from 0
/// \param first_trial  trial number of the block's first presentation; the others count up from it
/// \throws StudyError if the order is impossible for the study
/// \throws std::invalid_argument if the schedule has no such block
[[nodiscard]] std::vector<Presentation> restarted_block(const Study& study,
                                                        const ScheduleDraw& draw, int block,
                                                        int restarts_before, int first_trial);

/// Draws how far a gain is roved, uniformly in decibels.
/// \param range_db  width of the range, >= 0
/// \return from -range_db / 2 to range_db / 2
[[nodiscard]] double drawn_rove_db(double range_db, RandomStream& random);

class AdaptiveOrder;
/// The order of one participant whose answers decide what comes next.
/// \return null: the schedule says all
[[nodiscard]] std::unique_ptr<AdaptiveOrder> adaptive_order(const Study& study,
                                                            const ScheduleDraw& draw);

/// The name and version of the rule that makes schedules; the seal commits to it.
[[nodiscard]] std::string schedule_rule(const Study& study);

}  // namespace touchtrial::study
