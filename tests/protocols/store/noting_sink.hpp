/// \file A sink that remembers what was acknowledged.
#pragma once

#include "protocols/store/session_recorder.hpp"

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace touchtrial {

/// Passes events on, and notes those that were acknowledged.
class NotingSink final : public store::EventSink {
 public:
  /// \param acknowledged  outlives this
  NotingSink(std::unique_ptr<store::EventSink> sink, std::vector<store::Event>& acknowledged)
      : sink_(std::move(sink)), acknowledged_(acknowledged) {}

  void accept(const store::Event& event, const std::optional<store::SealedTrace>& trace) override {
    sink_->accept(event, trace);
    acknowledged_.push_back(event);
  }
  void accept_together(std::span<const store::RecordedEvent> events) override {
    sink_->accept_together(events);
    for (const store::RecordedEvent& recorded : events) acknowledged_.push_back(recorded.event);
  }

 private:
  std::unique_ptr<store::EventSink> sink_;
  std::vector<store::Event>& acknowledged_;
};

}  // namespace touchtrial
