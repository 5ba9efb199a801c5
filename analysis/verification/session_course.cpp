#include "analysis/verification/session_course.hpp"

#include "core/errors.hpp"
#include "protocols/store/payload_json.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::analysis {

SessionCourse::SessionCourse(const design::Study& study, int enrolment)
    : study_(study), enrolment_(enrolment), schedule_(design::make_schedule(study, enrolment)) {
  for (std::size_t i = 0; i < schedule_.presentations.size(); ++i) due_.push_back(i);
}

void SessionCourse::fail(const store::Event& event, const std::string& why) const {
  throw VerificationError(
      fmt::format("session {}, event {}: {}", event.session, event.sequence, why));
}

void SessionCourse::fail(const store::Event& event, int trial, const std::string& why) const {
  throw VerificationError(fmt::format("session {}, trial {}: {}", event.session, trial, why));
}

void SessionCourse::follow(const store::Event& event) {
  switch (event.kind) {
    case store::EventKind::presented:
      return present(event);
    case store::EventKind::first_contact:
    case store::EventKind::answered:
    case store::EventKind::timed_out:
    case store::EventKind::interrupted:
    case store::EventKind::explored_again:
      return follow_trial(event);
    case store::EventKind::block_restarted:
      return restart_block(event);
    case store::EventKind::paused:
      is_paused_ = true;
      return;
    case store::EventKind::resumed:
      return take_up(event);
    case store::EventKind::stopped:
      is_stopped_ = true;
      return;
    case store::EventKind::closed:
      return close(event);
    default:
      return;  // remarks, practice and traces stand anywhere
  }
}

bool SessionCourse::is_over() const {
  return is_timed_out_ && study_.trials.on_timeout == design::OnTimeout::no_response;
}

bool SessionCourse::was_voided(int trial) const {
  const auto& all = schedule_.presentations;
  return std::any_of(all.begin(), all.end(), [&](const design::Presentation& one) {
    const auto restarted = first_trials_.find(one.block);
    return one.trial == trial && restarted != first_trials_.end() && trial < restarted->second;
  });
}

void SessionCourse::present(const store::Event& event) {
  const store::TrialBody body = store::trial_from_json(event.body);
  const auto& all = schedule_.presentations;
  if (std::none_of(all.begin(), all.end(),
                   [&](const design::Presentation& one) { return one.trial == body.trial; })) {
    fail(event, body.trial, "was presented but not scheduled");
  }
  if (was_voided(body.trial)) {
    fail(event, body.trial, "was presented under its old number after its block was restarted");
  }
  if (is_paused_) fail(event, body.trial, "was presented while the session was paused");
  if (is_stopped_) fail(event, body.trial, "was presented after the session was stopped");
  if (block_to_restart_) {
    fail(event, body.trial,
         fmt::format("was presented although block {} was to be restarted", *block_to_restart_));
  }
  if (under_way_ && (!is_timed_out_ || is_spoilt_)) {
    fail(event, body.trial,
         fmt::format("was presented while trial {} was under way", all[*under_way_].trial));
  }
  if (due_.empty()) fail(event, body.trial, "was presented after all that was due");
  const design::Presentation& next = all[due_.front()];
  if (next.trial != body.trial) {
    fail(event, body.trial, fmt::format("was presented where trial {} was due", next.trial));
  }
  if (next.block != body.block) {
    fail(event, body.trial,
         fmt::format("was presented in block {}, not in {}", body.block, next.block));
  }
  under_way_ = due_.front();
  due_.pop_front();
  is_timed_out_ = false;
  ++presentations_;
}

void SessionCourse::require_under_way(const store::Event& event, int trial) const {
  const std::string name(name_of(event.kind));
  if (!under_way_ || schedule_.presentations[*under_way_].trial != trial) {
    fail(event, trial, name + ", but not under way");
  }
  if (event.kind == store::EventKind::interrupted) return;
  if (is_paused_) fail(event, trial, name + " while the session was paused");
  if (is_spoilt_) fail(event, trial, name + " although the program had ended in it");
}

void SessionCourse::follow_trial(const store::Event& event) {
  const int trial = store::trial_from_json(event.body).trial;
  require_under_way(event, trial);
  if (event.kind == store::EventKind::interrupted) return give_up(event, trial);
  if (event.kind == store::EventKind::timed_out) is_timed_out_ = true;
  if (event.kind == store::EventKind::answered) under_way_.reset();
}

void SessionCourse::give_up(const store::Event& event, int trial) {
  if (is_over()) {
    fail(event, trial, "interrupted, but its time was over");
  }
  const std::size_t spoilt = *under_way_;
  under_way_.reset();
  is_spoilt_ = false;
  switch (study_.trials.on_interruption) {
    case design::OnInterruption::repeat:
      due_.push_back(spoilt);
      return;
    case design::OnInterruption::leave_out:
      return;
    case design::OnInterruption::restart_block:
      block_to_restart_ = schedule_.presentations[spoilt].block;
      return;
  }
}

void SessionCourse::restart_block(const store::Event& event) {
  const store::BlockBody body = store::block_from_json(event.body);
  if (block_to_restart_ != body.block) {
    fail(event, fmt::format("block {} was restarted, but nothing in it was interrupted, or the "
                            "study does not restart blocks",
                            body.block));
  }
  auto& all = schedule_.presentations;
  const int first =
      std::max_element(all.begin(), all.end(),
                       [](const auto& one, const auto& two) { return one.trial < two.trial; })
          ->trial +
      1;
  if (body.first_trial != first) {
    fail(event, fmt::format("block {} was restarted with trial {}, not {}", body.block,
                            body.first_trial, first));
  }
  std::erase_if(due_, [&](std::size_t i) { return all[i].block == body.block; });
  const std::vector<design::Presentation> again =
      design::restarted_block(study_, enrolment_, body.block, restarts_[body.block]++, first);
  for (std::size_t i = again.size(); i-- > 0;) due_.push_front(all.size() + i);
  all.insert(all.end(), again.begin(), again.end());
  first_trials_[body.block] = first;
  block_to_restart_.reset();
}

void SessionCourse::take_up(const store::Event& event) {
  constexpr double kSecondsInHour = 3600.0;
  const store::ResumedBody body = store::resumed_from_json(event.body);
  if (body.after == "pause") {
    if (!is_paused_) fail(event, "the session was resumed, but not paused");
  } else if (body.away_s > study_.trials.resume_within_h * kSecondsInHour) {
    fail(event, fmt::format("the session was taken up after {:.1f} h; the study allows {} h",
                            body.away_s / kSecondsInHour, study_.trials.resume_within_h));
  } else {
    is_spoilt_ = under_way_.has_value() && !is_over();
  }
  is_paused_ = false;
}

void SessionCourse::close(const store::Event& event) const {
  if (!store::completion_from_json(event.body)) return;
  if (is_stopped_) fail(event, "the session is complete, but was stopped");
  if (block_to_restart_) {
    fail(event, fmt::format("the session is complete, but block {} was not restarted",
                            *block_to_restart_));
  }
  if (under_way_ && !is_timed_out_) {
    fail(event, schedule_.presentations[*under_way_].trial,
         "the session is complete, but this trial has no answer");
  }
  if (!due_.empty()) {
    fail(event, schedule_.presentations[due_.front()].trial,
         "the session is complete, but this trial was still due");
  }
}

}  // namespace touchtrial::analysis
