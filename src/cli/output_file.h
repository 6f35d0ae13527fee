#pragma once

#include "flute_grinder/geometry/replace_file.h"
#include "flute_grinder/job/file_error.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

namespace grinder {

/// @throw FileError if the command has read this file, by whatever name.
void requireNotRead(const std::string& path);

/// A file that a command writes: the one way to do it. Opened before the work begins; what was in it stays until
/// close(), which replaces it in one step. A FIFO, a device and the program's own standard output are written to as
/// they are.
class OutputFile {
 public:
  /// @throw FileError if it cannot be written, or is another file of the command: one that it has read, or writes.
  explicit OutputFile(std::string path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  const std::string& path() const { return path_; }
  std::FILE* stream() const { return stream_.get(); }
  /// As an argument of a program that writes into it, once that has inherited its descriptor: `DESCRIPTOR:PATH`.
  std::string forProgram() const;

  /// @param error errno of a write that failed; 0 if none did.
  /// @throw WriteError if writing failed, FileError if the command has read the file since.
  void close(int error = 0);

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::string path_;
  std::optional<FileReplacement> replacement_;  ///< nothing for a FIFO, a device and standard output
  std::unique_ptr<std::FILE, Closer> stream_;
};

/// Null for an empty path. @throw FileError
std::unique_ptr<OutputFile> openOutput(const std::string& path);

}  // namespace grinder
