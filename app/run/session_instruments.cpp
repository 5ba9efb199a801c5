#include "app/run/session_instruments.hpp"

#include "device/instruments/lab_streaming.hpp"
#include "device/instruments/marker_line.hpp"

#include <atomic>
#include <optional>
#include <string>

namespace touchtrial::app {
namespace {

class LabInstruments final : public session::Instruments {
 public:
  LabInstruments(const device::InstrumentSettings& settings, double rate_hz) {
    if (!settings.serial.port.empty()) serial_line_.emplace(settings.serial);
    if (!settings.lsl.library.empty()) lsl_.emplace(settings.lsl, rate_hz);
  }

  void mark(Mark mark, int trial, TimePoint time) noexcept override {
    const int code = static_cast<int>(mark);
    if (serial_line_) serial_line_->send(code, trial, time);
    if (lsl_) {
      std::string text(record::name_of(mark));
      if (trial > 0) text += " " + std::to_string(trial);
      lsl_->mark(text, time);
    }
    marks_.fetch_add(1, std::memory_order_relaxed);
  }

  void feel(const device::ServoSample& sample, TimePoint time) noexcept override {
    if (lsl_) lsl_->push(sample.position_mm, sample.force_n, time);
  }

  [[nodiscard]] Report take() override {
    Report report;
    const std::size_t marks = marks_.exchange(0, std::memory_order_relaxed);
    if (serial_line_) {
      for (const device::SentMarker& marker : serial_line_->take())
        report.latencies.push_back(marker.latency);
    }
    report.latencies.resize(marks);
    if (lsl_) {
      const device::ClockOffset clock = lsl_->read_clock();
      report.clock_zero_s = clock.offset_s;
      report.clock_uncertainty_s = clock.uncertainty_s;
    }
    return report;
  }

 private:
  std::optional<device::MarkerLine> serial_line_;
  std::optional<device::LabStreaming> lsl_;
  std::atomic<std::size_t> marks_{0};
};

}  // namespace

std::unique_ptr<session::Instruments> session_instruments(
    const device::InstrumentSettings& settings, double rate_hz) {
  if (!settings.any()) return nullptr;
  return std::make_unique<LabInstruments>(settings, rate_hz);
}

}  // namespace touchtrial::app
