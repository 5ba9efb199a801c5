/// \file PortAudio, for outputs and inputs of the computer's sound card.
#pragma once

#include "core/errors.hpp"
#include "core/text.hpp"
#include "device/platform/dynamic_library.hpp"

#include <cstdio>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <portaudio.h>
#include <unistd.h>

namespace touchtrial::app {

/// Discards standard error while it lives: in search of outputs, ALSA and JACK write a line there
/// for everything that a machine lacks.
class QuietErrors {
 public:
  QuietErrors() : kept_(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0)) {
    if (kept_ < 0) return;
    std::fflush(stderr);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    ::dup2(nowhere, STDERR_FILENO);
    ::close(nowhere);
  }
  ~QuietErrors() {
    if (kept_ < 0) return;
    ::dup2(kept_, STDERR_FILENO);
    ::close(kept_);
  }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  int kept_;
};

/// PortAudio, which is loaded for the first sound, because no other command needs it (decision 47).
class PortAudio {
 public:
  PortAudio() { insist(initialize_(), "cannot be initialised", kPlugIn); }
  ~PortAudio() {
    const QuietErrors quiet;
    terminate_();
  }
  PortAudio(const PortAudio&) = delete;
  PortAudio& operator=(const PortAudio&) = delete;

  /// The default output, not started yet.
  [[nodiscard]] PaStream* opened(PaStreamCallback* callback, void* data, double rate_hz) const {
    PaStream* stream = nullptr;
    // One channel: the system sends it to both ears.
    insist(open_(&stream, 0, 1, paFloat32, rate_hz, paFramesPerBufferUnspecified, callback, data),
           "the output cannot be opened", kPlugIn);
    return stream;
  }
  /// An input by its name or a part of it, not started yet.
  /// \throws DeviceError naming the inputs that there are if none has this name and these channels
  [[nodiscard]] PaStream* opened_input(const std::string& name, int channels,
                                       PaStreamCallback* callback, void* data,
                                       double rate_hz) const {
    std::string others;
    for (PaDeviceIndex i = 0; i < count_(); ++i) {
      const PaDeviceInfo* device = info_(i);
      if (device == nullptr || device->maxInputChannels < channels) continue;
      if (std::string_view(device->name).find(name) == std::string_view::npos) {
        others += (others.empty() ? "" : ", ") + std::string(device->name);
        continue;
      }
      const PaStreamParameters input{i, channels, paFloat32, device->defaultHighInputLatency,
                                     nullptr};
      PaStream* stream = nullptr;
      insist(open_any_(&stream, &input, nullptr, rate_hz, paFramesPerBufferUnspecified, paClipOff,
                       callback, data),
             "the input cannot be opened", kOtherInput);
      return stream;
    }
    throw DeviceError(one_line(
        "sound: no input with " + std::to_string(channels) + " channels is called '" + name +
        "'; " + (others.empty() ? "there is none at all: connect one" : "there are: " + others)));
  }
  void start(PaStream* stream) const {
    const PaError started = start_(stream);
    if (started != paNoError) close_(stream);
    insist(started, "it cannot be started", kPlugIn);
  }
  void stop(PaStream* stream) const noexcept { stop_(stream); }
  void close(PaStream* stream) const noexcept { close_(stream); }
  [[nodiscard]] bool is_active(PaStream* stream) const noexcept { return is_active_(stream) == 1; }

 private:
  static constexpr const char* kPlugIn =
      "connect headphones, and check whether another program uses the sound card";
  static constexpr const char* kOtherInput =
      "check its rate and channels, and whether another program uses it";

  void insist(PaError error, const char* what, const char* remedy) const {
    if (error == paNoError) return;
    throw DeviceError(std::string("sound: ") + what + ": " + error_text_(error) + "; " + remedy);
  }
  template <typename Function>
  [[nodiscard]] Function* named(const char* name) const {
    return library_.function<Function>(name);
  }

  device::DynamicLibrary library_{"libportaudio.so.2", device::Unload::never,
                                  "for sound install PortAudio (libportaudio2)"};
  decltype(&Pa_Initialize) initialize_ = named<decltype(Pa_Initialize)>("Pa_Initialize");
  decltype(&Pa_Terminate) terminate_ = named<decltype(Pa_Terminate)>("Pa_Terminate");
  decltype(&Pa_GetErrorText) error_text_ = named<decltype(Pa_GetErrorText)>("Pa_GetErrorText");
  decltype(&Pa_OpenDefaultStream) open_ =
      named<decltype(Pa_OpenDefaultStream)>("Pa_OpenDefaultStream");
  decltype(&Pa_GetDeviceCount) count_ = named<decltype(Pa_GetDeviceCount)>("Pa_GetDeviceCount");
  decltype(&Pa_GetDeviceInfo) info_ = named<decltype(Pa_GetDeviceInfo)>("Pa_GetDeviceInfo");
  decltype(&Pa_OpenStream) open_any_ = named<decltype(Pa_OpenStream)>("Pa_OpenStream");
  decltype(&Pa_StopStream) stop_ = named<decltype(Pa_StopStream)>("Pa_StopStream");
  decltype(&Pa_StartStream) start_ = named<decltype(Pa_StartStream)>("Pa_StartStream");
  decltype(&Pa_CloseStream) close_ = named<decltype(Pa_CloseStream)>("Pa_CloseStream");
  decltype(&Pa_IsStreamActive) is_active_ = named<decltype(Pa_IsStreamActive)>("Pa_IsStreamActive");
};

}  // namespace touchtrial::app
