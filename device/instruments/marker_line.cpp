#include "device/instruments/marker_line.hpp"

#include "core/errors.hpp"

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

namespace touchtrial::device {
namespace {

using Clock = std::chrono::steady_clock;

/// Write timeout, after which the marker is lost.
constexpr int kWriteTimeoutMs = 100;

constexpr std::array<std::pair<int, speed_t>, 10> kRates = {{{9'600, B9600},
                                                             {19'200, B19200},
                                                             {38'400, B38400},
                                                             {57'600, B57600},
                                                             {115'200, B115200},
                                                             {230'400, B230400},
                                                             {460'800, B460800},
                                                             {500'000, B500000},
                                                             {921'600, B921600},
                                                             {1'000'000, B1000000}}};

[[noreturn]] void refuse_port(const MarkerLineSettings& settings, const std::string& problem) {
  throw DeviceError(one_line("instruments.serial: " + settings.port.string() + ": " + problem));
}

std::string error_text(int error) {
  return std::generic_category().message(error);
}

speed_t rate_of(const MarkerLineSettings& settings) {
  std::string supported;
  for (const auto& [baud, rate] : kRates) {
    if (baud == settings.baud) return rate;
    supported += (supported.empty() ? "" : ", ") + std::to_string(baud);
  }
  refuse_port(settings, std::to_string(settings.baud) +
                            " baud is not a supported rate; set one of " + supported);
}

/// Configures raw bytes: 8N1, no flow control, no translation.
void make_raw(const MarkerLineSettings& settings, int descriptor) {
  termios line{};
  if (::tcgetattr(descriptor, &line) != 0) {
    refuse_port(settings, "is not a serial line; name one, for instance /dev/ttyUSB0");
  }
  ::cfmakeraw(&line);
  line.c_cflag |= static_cast<tcflag_t>(CLOCAL | CREAD);
  line.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
  const speed_t rate = rate_of(settings);
  if (::cfsetispeed(&line, rate) != 0 || ::cfsetospeed(&line, rate) != 0 ||
      ::tcsetattr(descriptor, TCSANOW, &line) != 0) {
    refuse_port(settings, "does not support " + std::to_string(settings.baud) + " baud (" +
                              error_text(errno) + "); set another rate");
  }
}

int open_port(const MarkerLineSettings& settings) {
  const int descriptor =
      ::open(settings.port.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    const int error = errno;
    refuse_port(settings, error_text(error) + (error == EACCES
                                                   ? "; add the user to the group dialout"
                                                   : "; connect the instrument, or remove the line "
                                                     "from the device settings"));
  }
  try {
    make_raw(settings, descriptor);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  return descriptor;
}

}  // namespace

std::string marker_bytes(const MarkerLineSettings& settings, int code, int trial) {
  if (settings.format == MarkerFormat::text) {
    std::string number = std::to_string(trial);
    const auto width = static_cast<std::size_t>(settings.width);
    if (number.size() < width) number.insert(0, width - number.size(), '0');
    return "E" + std::to_string(code) + " T" + number + "\n";
  }
  std::string bytes(1, static_cast<char>(code));
  for (int i = settings.width - 1; i >= 0; --i) {
    bytes += static_cast<char>(static_cast<unsigned>(trial) >> (8 * i) & 0xffU);
  }
  return bytes;
}

MarkerLine::MarkerLine(const MarkerLineSettings& settings)
    : settings_(settings), descriptor_(open_port(settings)), thread_([this] { run(); }) {}

MarkerLine::~MarkerLine() {
  {
    const std::lock_guard lock(mutex_);
    is_closing_ = true;
  }
  work_ready_.notify_one();
  thread_.join();
  ::close(descriptor_);
}

void MarkerLine::send(int code, int trial, TimePoint time) noexcept {
  {
    const std::lock_guard lock(mutex_);
    pending_.push_back({marker_bytes(settings_, code, trial), time});
  }
  work_ready_.notify_one();
}

std::vector<SentMarker> MarkerLine::take() {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [this] { return pending_.empty() && !is_writing_; });
  return std::exchange(sent_, {});
}

void MarkerLine::run() noexcept {
  const bool resets_lines = settings_.format == MarkerFormat::byte && settings_.reset_ms > 0.0;
  const auto reset_after = std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double, std::milli>(settings_.reset_ms));
  bool needs_reset = false;
  Clock::time_point reset_time{};
  std::unique_lock lock(mutex_);
  const auto has_work = [this] { return is_closing_ || !pending_.empty(); };
  while (true) {
    if (!needs_reset) {
      work_ready_.wait(lock, has_work);
    } else if (!work_ready_.wait_until(lock, reset_time, has_work)) {
      needs_reset = false;
      lock.unlock();
      static_cast<void>(write(std::string(1, '\0')));
      lock.lock();
      continue;
    }
    if (pending_.empty()) break;
    const PendingMarker next = std::move(pending_.front());
    pending_.pop_front();
    is_writing_ = true;
    lock.unlock();
    const bool is_written = write(next.bytes);
    const Clock::time_point now = Clock::now();
    lock.lock();
    is_writing_ = false;
    sent_.push_back(
        {is_written ? std::optional(std::chrono::nanoseconds(now - next.time)) : std::nullopt});
    needs_reset = resets_lines;
    reset_time = now + reset_after;
    idle_.notify_all();
  }
  lock.unlock();
  if (needs_reset) static_cast<void>(write(std::string(1, '\0')));
}

bool MarkerLine::write(const std::string& bytes) noexcept {
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t count = ::write(descriptor_, bytes.data() + written, bytes.size() - written);
    if (count > 0) {
      written += static_cast<std::size_t>(count);
      continue;
    }
    if (count < 0 && errno == EINTR) continue;
    if (count == 0 || (errno != EAGAIN && errno != EWOULDBLOCK)) return false;
    pollfd line{descriptor_, POLLOUT, 0};
    if (::poll(&line, 1, kWriteTimeoutMs) <= 0) return false;
  }
  return true;
}

}  // namespace touchtrial::device
