#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "common/posix/unique_fd.h"

namespace cuscus::orchestrator {

/// A file that appears under its name when all of it is there, or never: it has no name until then,
/// where the file system knows such files, and dies with this process. Elsewhere it has a hidden
/// name beside its own. Nothing is overwritten.
class WholeFile {
 public:
  /// @throws UsageError when the name is taken or no file can be made there
  explicit WholeFile(std::filesystem::path path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void append(std::string_view bytes);
  /// Gives the file its name, and to whoever called sudo.
  /// @throws UsageError when the name has been taken meanwhile
  void publish();

 private:
  std::filesystem::path path_;
  std::filesystem::path beside_;  ///< Empty for a file without a name.
  posix::UniqueFd file_;
};

/// Writes a file with this content.
void write_whole_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace cuscus::orchestrator
