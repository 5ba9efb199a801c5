#include "protocols/session/instruments.hpp"

#include "protocols/session/exploration.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace touchtrial::session {
namespace {

using record::Mark;
using Clock = std::chrono::steady_clock;

/// The mark that an input sends immediately. Plane-on and contact are derived from the servo's
/// samples.
std::optional<Mark> mark_of(SessionInput input) {
  switch (input) {
    case SessionInput::end_exploring:
      return Mark::plane_off;
    case SessionInput::time_out:
      return Mark::time_up;
    case SessionInput::interrupt:
      return Mark::interrupted;
    case SessionInput::confirm:
      return Mark::answered;
    case SessionInput::practise:
      return Mark::practised;
    case SessionInput::take_break:
      return Mark::break_taken;
    case SessionInput::pause:
      return Mark::paused;
    case SessionInput::resume:
      return Mark::resumed;
    case SessionInput::stop:
      return Mark::stopped;
    default:
      return std::nullopt;
  }
}

}  // namespace

SessionMarks::SessionMarks(Instruments* instruments, Session& session, double rate_hz)
    : instruments_(instruments), session_(session), rate_hz_(rate_hz) {
  if (instruments_ == nullptr) return;
  session_.set_observer([this](SessionInput input, int trial) { send_mark_of(input, trial); });
}

void SessionMarks::send_mark_of(SessionInput input, int trial) {
  if (input == SessionInput::present || input == SessionInput::explore_again) trial_ = trial;
  const std::optional<Mark> new_mark = mark_of(input);
  if (!new_mark) return;
  const bool is_in_trial = *new_mark == Mark::plane_off || *new_mark == Mark::time_up ||
                           *new_mark == Mark::interrupted || *new_mark == Mark::answered;
  mark(*new_mark, is_in_trial ? trial : 0, Clock::now());
  if (*new_mark == Mark::answered || *new_mark == Mark::interrupted) trial_ = 0;
}

void SessionMarks::note_plane_on(TimePoint began) noexcept {
  if (instruments_ == nullptr) return;
  plane_on_at_ = began;
  has_landed_ = false;
  mark(Mark::plane_on, trial_, began);
}

void SessionMarks::feel(const device::ServoSample& sample) noexcept {
  if (instruments_ == nullptr) return;
  const TimePoint at = plane_on_at_ + time_of_tick(sample.tick, rate_hz_);
  if (!std::exchange(has_landed_, has_landed_ || sample.position_mm.z < kLandingHeightMm) &&
      has_landed_) {
    mark(Mark::contact, trial_, at);
  }
  instruments_->feel(sample, at);
}

void SessionMarks::mark(Mark mark, int trial, TimePoint at) noexcept {
  if (instruments_ == nullptr) return;
  instruments_->mark(mark, trial, at);
  sent_.push_back({mark, trial, at});
}

std::optional<record::MarksBody> SessionMarks::take(SessionClock& clock) {
  if (instruments_ == nullptr || sent_.empty()) return std::nullopt;
  const TimePoint now = Clock::now();
  const TimePoint zero = now - clock.time_of(now);
  const Instruments::Report report = instruments_->take();
  if (report.latencies.size() != sent_.size()) {
    throw std::logic_error("instruments: the number of latencies differs from the number of marks");
  }
  record::MarksBody body;
  for (std::size_t i = 0; i < sent_.size(); ++i) {
    const SentMark& sent = sent_[i];
    body.codes.push_back(static_cast<int>(sent.mark));
    body.trials.push_back(sent.trial);
    // In a resumed session, marks may precede the zero of the clock.
    body.at_ns.push_back(std::max<std::int64_t>(0, (sent.at - zero).count()));
    body.latency_ns.push_back(std::max<std::int64_t>(
        0, report.latencies[i].value_or(std::chrono::nanoseconds(0)).count()));
  }
  if (report.clock_zero_s) {
    body.lsl_zero_s =
        *report.clock_zero_s + std::chrono::duration<double>(zero.time_since_epoch()).count();
    body.lsl_uncertainty_s = report.clock_uncertainty_s;
  }
  sent_.clear();
  return body;
}

}  // namespace touchtrial::session
