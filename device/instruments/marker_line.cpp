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

[[noreturn]] void refuse_port(const MarkerLineSettings& settings, const std::string& why) {
  throw DeviceError(one_line("instruments.serial: " + settings.port.string() + ": " + why));
}

std::string error_text(int error) {
  return std::generic_category().message(error);
}

speed_t rate_of(const MarkerLineSettings& settings) {
  std::string known;
  for (const auto& [baud, rate] : kRates) {
    if (baud == settings.baud) return rate;
    known += (known.empty() ? "" : ", ") + std::to_string(baud);
  }
  refuse_port(settings,
              std::to_string(settings.baud) + " baud is not a supported rate; set one of " + known);
}

/// Raw bytes: 8N1, no flow control, no translation.
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
    refuse_port(settings, "does not take " + std::to_string(settings.baud) + " baud (" +
                              error_text(errno) + "); set another rate");
  }
}

int open_port(const MarkerLineSettings& settings) {
  const int descriptor =
      ::open(settings.port.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) {
    const int error = errno;
    refuse_port(settings, error_text(error) +
                              (error == EACCES ? "; add the user to the group dialout"
                                               : "; plug the instrument in, or take the line out "
                                                 "of the device settings"));
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
  woken_.notify_one();
  thread_.join();
  ::close(descriptor_);
}

void MarkerLine::send(int code, int trial, TimePoint at) noexcept {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back({marker_bytes(settings_, code, trial), at});
  }
  woken_.notify_one();
}

std::vector<SentMarker> MarkerLine::take() {
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return waiting_.empty() && !is_writing_; });
  return std::exchange(sent_, {});
}

void MarkerLine::run() noexcept {
  const bool resets = settings_.format == MarkerFormat::byte && settings_.reset_ms > 0.0;
  const auto reset_after = std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double, std::milli>(settings_.reset_ms));
  bool is_set = false;  // the lines of a trigger box
  Clock::time_point reset_at{};
  std::unique_lock lock(mutex_);
  const auto has_work = [this] { return is_closing_ || !waiting_.empty(); };
  while (true) {
    if (!is_set) {
      woken_.wait(lock, has_work);
    } else if (!woken_.wait_until(lock, reset_at, has_work)) {
      is_set = false;
      lock.unlock();
      static_cast<void>(write(std::string(1, '\0')));
      lock.lock();
      continue;
    }
    if (waiting_.empty()) break;
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    is_writing_ = true;
    lock.unlock();
    const bool is_written = write(next.bytes);
    const Clock::time_point now = Clock::now();
    lock.lock();
    is_writing_ = false;
    sent_.push_back(
        {is_written ? std::optional(std::chrono::nanoseconds(now - next.at)) : std::nullopt});
    is_set = resets;
    reset_at = now + reset_after;
    done_.notify_all();
  }
  lock.unlock();
  if (is_set) static_cast<void>(write(std::string(1, '\0')));
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
