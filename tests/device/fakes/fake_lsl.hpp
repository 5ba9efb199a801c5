/// \file What the stand-in for liblsl was given.
#pragma once

#include <mutex>
#include <string>
#include <vector>

namespace touchtrial::fakes {

struct FakeLslStream {
  std::string name;
  std::string type;
  int channels = 0;
  double rate_hz = 0.0;
  int format = 0;
  std::vector<std::string> labels;
  bool is_open = false;
};

struct FakeLslSample {
  std::string stream;  ///< name
  std::vector<double> values;
  std::string text;
  double stamp = 0.0;
};

struct FakeLsl {
  std::mutex mutex;
  double ahead_s = 0.0;  ///< its clock, of the monotonic clock
  bool makes_outlets = true;
  int misuses = 0;
  std::vector<FakeLslStream> streams;
  std::vector<FakeLslSample> samples;
};

}  // namespace touchtrial::fakes

extern "C" touchtrial::fakes::FakeLsl* fake_lsl();
