#include "app/sound/sound_card.hpp"

#include "core/errors.hpp"

#include <cstddef>
#include <cstdio>
#include <span>
#include <string>

#include <fcntl.h>
#include <portaudio.h>
#include <unistd.h>

namespace touchtrial::app {
namespace {

/// While it lives, standard error leads nowhere: looking for outputs, ALSA and JACK write a line
/// there for everything that a machine has not.
class QuietErrors {
 public:
  QuietErrors() : kept_(::dup(STDERR_FILENO)) {
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

void insist(PaError error, const char* what) {
  if (error == paNoError) return;
  throw DeviceError(std::string("sound: ") + what + ": " + Pa_GetErrorText(error) +
                    "; connect headphones, and look whether another program has the sound card");
}

int give_samples(const void* /*input*/, void* output, unsigned long frames,
                 const PaStreamCallbackTimeInfo* /*times*/, PaStreamCallbackFlags /*flags*/,
                 void* mixer) {
  static_cast<SoundMixer*>(mixer)->render({static_cast<float*>(output), frames});
  return paContinue;
}

}  // namespace

struct SoundCard::Stream {
  struct Library {
    Library() { insist(Pa_Initialize(), "cannot be initialised"); }
    ~Library() {
      const QuietErrors quiet;
      Pa_Terminate();
    }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;
  };
  explicit Stream(SoundMixer& mixer) {
    // One channel: the system sends it to both ears.
    insist(Pa_OpenDefaultStream(&stream, 0, 1, paFloat32, kRateHz, paFramesPerBufferUnspecified,
                                give_samples, &mixer),
           "the output cannot be opened");
    const PaError started = Pa_StartStream(stream);
    if (started != paNoError) Pa_CloseStream(stream);
    insist(started, "the output cannot be started");
  }
  ~Stream() { Pa_CloseStream(stream); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  Library library;
  PaStream* stream = nullptr;
};

SoundCard::SoundCard(SoundMixer& mixer) {
  const QuietErrors quiet;
  stream_ = std::make_unique<Stream>(mixer);
}

SoundCard::~SoundCard() = default;

bool SoundCard::plays() const noexcept {
  return Pa_IsStreamActive(stream_->stream) == 1;
}

}  // namespace touchtrial::app
