/// \file A sink that remembers what was acknowledged.
#pragma once

#include "record/session_recorder.hpp"

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace touchtrial {

/// Passes events on, and notes those that were acknowledged.
class NotingSink final : public record::EventSink {
 public:
  /// \param acknowledged  outlives this
  NotingSink(std::unique_ptr<record::EventSink> sink, std::vector<record::Event>& acknowledged)
      : sink_(std::move(sink)), acknowledged_(acknowledged) {}

  void accept(const record::Event& event,
              const std::optional<record::SealedTrace>& trace) override {
    sink_->accept(event, trace);
    acknowledged_.push_back(event);
  }
  void accept_together(std::span<const record::RecordedEvent> events) override {
    sink_->accept_together(events);
    for (const record::RecordedEvent& recorded : events) acknowledged_.push_back(recorded.event);
  }

 private:
  std::unique_ptr<record::EventSink> sink_;
  std::vector<record::Event>& acknowledged_;
};

}  // namespace touchtrial
