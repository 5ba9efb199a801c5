/// \file The instrument's side of a serial line, on a pseudo terminal.
#pragma once

#include "device/instruments/marker_line.hpp"
#include "support/catch.hpp"

#include <cstddef>
#include <string>

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

namespace touchtrial {

/// Reads what an instrument would.
class Instrument {
 public:
  Instrument() : descriptor_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    REQUIRE(descriptor_ >= 0);
    REQUIRE(::grantpt(descriptor_) == 0);
    REQUIRE(::unlockpt(descriptor_) == 0);
    settings.port = ::ptsname(descriptor_);
  }
  ~Instrument() { unplug(); }
  Instrument(const Instrument&) = delete;
  Instrument& operator=(const Instrument&) = delete;

  void unplug() {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
  }

  /// Waits for this many bytes.
  [[nodiscard]] std::string read(std::size_t count) {
    std::string bytes;
    while (bytes.size() < count) {
      pollfd line{descriptor_, POLLIN, 0};
      REQUIRE(::poll(&line, 1, 300'000) == 1);
      std::string some(count - bytes.size(), '\0');
      const ssize_t got = ::read(descriptor_, some.data(), some.size());
      REQUIRE(got > 0);
      bytes += some.substr(0, static_cast<std::size_t>(got));
    }
    return bytes;
  }

  device::MarkerLineSettings settings;

 private:
  int descriptor_;
};

}  // namespace touchtrial
