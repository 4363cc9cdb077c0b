#include "orchestrator/app/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <system_error>
#include <utility>

#include "common/posix/check.h"
#include "orchestrator/app/exit_code.h"
#include "orchestrator/app/ownership.h"

namespace cuscus::orchestrator {
namespace {

namespace fs = std::filesystem;

constexpr int kReadableByAll = 0666;  // less the umask

UsageError cannot_make(const fs::path& path, int error) {
  return UsageError{
      fmt::format("--out {}: {}", path.native(), std::system_category().message(error))};
}

UsageError taken(const fs::path& path) {
  return UsageError{fmt::format("--out {}: the file exists", path.native())};
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path{"."};
}

}  // namespace

WholeFile::WholeFile(fs::path path) : path_{std::move(path)} {
  if (!path_.has_filename()) {
    throw UsageError{fmt::format("--out {}: the name of a file is missing", path_.native())};
  }
  std::error_code error;  // of a folder that may not be searched; a missing one is found below
  if (fs::exists(fs::symlink_status(path_, error))) {
    throw taken(path_);
  }
  const fs::path folder = folder_of(path_);
  int fd = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, kReadableByAll);
  if (fd < 0 && (errno == EOPNOTSUPP || errno == EISDIR)) {
    beside_ = folder / fmt::format(".{}.{}", path_.filename().native(), ::getpid());
    fd = ::open(beside_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, kReadableByAll);
  }
  if (fd < 0) {
    const int cause = errno;
    beside_.clear();
    throw cannot_make(path_, cause);
  }
  file_ = posix::UniqueFd{fd};
}

WholeFile::~WholeFile() {
  if (!beside_.empty()) {
    ::unlink(beside_.c_str());
  }
}

void WholeFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count =
        posix::check("write a file", ::write(file_.get(), bytes.data(), bytes.size()));
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

void WholeFile::publish() {
  if (const auto owner = sudo_caller()) {
    posix::check("give a file to its owner", ::fchown(file_.get(), owner->uid, owner->gid));
  }
  // Of a file without a name, /proc knows a link (open(2), O_TMPFILE).
  const std::string from =
      beside_.empty() ? fmt::format("/proc/self/fd/{}", file_.get()) : beside_.native();
  if (::linkat(AT_FDCWD, from.c_str(), AT_FDCWD, path_.c_str(), AT_SYMLINK_FOLLOW) < 0) {
    throw errno == EEXIST ? taken(path_) : cannot_make(path_, errno);
  }
}

void write_whole_file(const fs::path& path, std::string_view bytes) {
  WholeFile file{path};
  file.append(bytes);
  file.publish();
}

}  // namespace cuscus::orchestrator
