#pragma once

#include <sys/stat.h>

#include <string>

namespace grinder {

/// What a file is to hold, whether there is one or not. Until commit() it is nowhere to be seen, and gone if the
/// process ends before. Then whoever reads the file sees the old contents or the new ones, also after a power failure.
/// Mode and owner stay; of a symbolic link, the file behind it is replaced. All but the destructor throw
/// std::system_error for what cannot be done; the file is then as it was.
class FileReplacement {
 public:
  explicit FileReplacement(const std::string& path);
  /// For one writer at a time: mode and owner are a new file's, and a symbolic link is replaced itself.
  /// @param fresh until commit() the contents have this name; what has it, as after a crash, is overwritten.
  FileReplacement(const std::string& path, const std::string& fresh);
  FileReplacement(const FileReplacement&) = delete;
  FileReplacement& operator=(const FileReplacement&) = delete;
  ~FileReplacement();

  /// Of the new contents, open for writing.
  int descriptor() const { return descriptor_; }

  /// The file behind all symbolic links.
  const std::string& file() const { return file_; }

  void commit();

 private:
  const std::string file_;
  std::string fresh_;  ///< path of the new contents; empty while they have none
  struct stat old_ {};
  bool is_new_ = false;
  int descriptor_ = -1;
};

/// Gives a file a new text, as FileReplacement does; returns once it is on the disk.
/// @throw std::system_error if that cannot be done; the file is then as it was, unless it is its folder that cannot be
///        synchronized.
void replaceFile(const std::string& path, const std::string& text);

/// The same for one writer at a time, see FileReplacement, whose text is in a file of this name and the suffix `.new`
/// until it is on the disk; after a power failure the new file is certain only once settleFile() has returned.
/// @throw std::system_error if that cannot be done; the file is then as it was.
void writeFile(const std::string& path, const std::string& text);

/// Returns once the file's name on the disk stands for the text written last.
/// @throw std::system_error if its folder cannot be synchronized.
void settleFile(const std::string& path);

}  // namespace grinder
