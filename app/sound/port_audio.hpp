/// \file PortAudio, for the computer's sound card.
#pragma once

#include "core/errors.hpp"
#include "device/platform/dynamic_library.hpp"

#include <cstdio>
#include <string>

#include <fcntl.h>
#include <portaudio.h>
#include <unistd.h>

namespace touchtrial::app {

/// Discards standard error while it exists, because ALSA and JACK write a line there for every
/// missing output.
class QuietErrors {
 public:
  QuietErrors() : saved_descriptor_(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0)) {
    if (saved_descriptor_ < 0) return;
    std::fflush(stderr);
    const int dev_null = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (dev_null < 0) return;
    ::dup2(dev_null, STDERR_FILENO);
    ::close(dev_null);
  }
  ~QuietErrors() {
    if (saved_descriptor_ < 0) return;
    ::dup2(saved_descriptor_, STDERR_FILENO);
    ::close(saved_descriptor_);
  }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  int saved_descriptor_;
};

/// PortAudio, loaded for the first sound, because no other command needs it (decision 47).
class PortAudio {
 public:
  PortAudio() { check(initialize_(), "cannot be initialised"); }
  ~PortAudio() {
    const QuietErrors quiet;
    terminate_();
  }
  PortAudio(const PortAudio&) = delete;
  PortAudio& operator=(const PortAudio&) = delete;

  /// The default output, not started yet.
  [[nodiscard]] PaStream* open_default_output(PaStreamCallback* callback, void* data,
                                              double rate_hz) const {
    PaStream* stream = nullptr;
    // The system plays one channel on both ears.
    check(open_(&stream, 0, 1, paFloat32, rate_hz, paFramesPerBufferUnspecified, callback, data),
          "the output cannot be opened");
    return stream;
  }
  void start(PaStream* stream) const {
    const PaError error = start_(stream);
    if (error != paNoError) close_(stream);
    check(error, "it cannot be started");
  }
  void close(PaStream* stream) const noexcept { close_(stream); }
  [[nodiscard]] bool is_active(PaStream* stream) const noexcept { return is_active_(stream) == 1; }

 private:
  void check(PaError error, const char* what) const {
    if (error == paNoError) return;
    throw DeviceError(
        std::string("sound: ") + what + ": " + error_text_(error) +
        "; connect headphones, and check whether another program uses the sound card");
  }
  template <typename Function>
  [[nodiscard]] Function* symbol(const char* name) const {
    return library_.function<Function>(name);
  }

  device::DynamicLibrary library_{"libportaudio.so.2", device::Unload::never,
                                  "for sound install PortAudio (libportaudio2)"};
  decltype(&Pa_Initialize) initialize_ = symbol<decltype(Pa_Initialize)>("Pa_Initialize");
  decltype(&Pa_Terminate) terminate_ = symbol<decltype(Pa_Terminate)>("Pa_Terminate");
  decltype(&Pa_GetErrorText) error_text_ = symbol<decltype(Pa_GetErrorText)>("Pa_GetErrorText");
  decltype(&Pa_OpenDefaultStream) open_ =
      symbol<decltype(Pa_OpenDefaultStream)>("Pa_OpenDefaultStream");
  decltype(&Pa_StartStream) start_ = symbol<decltype(Pa_StartStream)>("Pa_StartStream");
  decltype(&Pa_CloseStream) close_ = symbol<decltype(Pa_CloseStream)>("Pa_CloseStream");
  decltype(&Pa_IsStreamActive) is_active_ =
      symbol<decltype(Pa_IsStreamActive)>("Pa_IsStreamActive");
};

}  // namespace touchtrial::app
