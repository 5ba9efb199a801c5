/// \file Every error that a user can cause or meet. One line each: what, where, remedy.
#pragma once

#include <stdexcept>
#include <string>

namespace touchtrial {

/// Base of all errors that the program reports and survives. `what()` is one line of UTF-8 that
/// names what failed, where (file, JSON pointer, bus, key) and the remedy.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A command called with arguments that cannot be meant. Exit code 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// A study or subject file that breaks its schema. The message holds the file and the JSON
/// pointer. Exit code 2.
class StudyError : public Error {
 public:
  using Error::Error;
};

/// A file that is missing, unreadable, truncated, of the wrong kind, or cannot be written.
class FileError : public Error {
 public:
  using Error::Error;
};

/// A database that cannot be opened, belongs to another study, or refuses a write.
class StoreError : public Error {
 public:
  using Error::Error;
};

/// A device that is absent, faulty or not calibrated.
class DeviceError : public Error {
 public:
  using Error::Error;
};

/// Evidence that does not hold: a broken chain, seal, key, pack or schedule. Exit code 3.
class VerificationError : public Error {
 public:
  using Error::Error;
};

/// \return `text` on one line of UTF-8: control characters become spaces, bytes that are not UTF-8
///   `\xNN`, so that no file name or value can break a message, or the JSON that it is put into.
[[nodiscard]] std::string one_line(const std::string& text);

}  // namespace touchtrial
