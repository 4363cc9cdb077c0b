#pragma once

#include <netlink/attr.h>
#include <netlink/msg.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

namespace cuscus::netlink {

/// One rtnetlink request under construction (rtnetlink(7)): a fixed header, then attributes.
class RouteMessage {
 public:
  /// `header` is ifinfomsg, ifaddrmsg, ndmsg, rtmsg or tcmsg; NLM_F_REQUEST is added to `flags`.
  template <typename Header>
  RouteMessage(int type, int flags, Header header) : RouteMessage{type, flags} {
    append_header(&header, sizeof header);
  }

  RouteMessage& put(int attribute, std::span<const std::uint8_t> bytes);
  RouteMessage& put_u8(int attribute, std::uint8_t value);
  RouteMessage& put_u32(int attribute, std::uint32_t value);
  RouteMessage& put_text(int attribute, const std::string& text);

  /// Puts what `fill` puts inside an attribute of its own.
  template <typename Fill>
  RouteMessage& nest(int attribute, Fill&& fill) {
    nlattr* const start = begin_nest(attribute);
    std::forward<Fill>(fill)();
    ::nla_nest_end(message_.get(), start);
    return *this;
  }

  /// Appends a header inside an attribute, as VETH_INFO_PEER wants.
  template <typename Header>
  RouteMessage& put_header(Header header) {
    append_header(&header, sizeof header);
    return *this;
  }

  [[nodiscard]] nlmsghdr& header() noexcept { return *::nlmsg_hdr(message_.get()); }
  [[nodiscard]] std::span<const std::uint8_t> bytes() noexcept;

 private:
  struct Free {
    void operator()(nl_msg* message) const noexcept { ::nlmsg_free(message); }
  };

  RouteMessage(int type, int flags);
  void append_header(void* header, std::size_t size);
  nlattr* begin_nest(int attribute);

  std::unique_ptr<nl_msg, Free> message_;
};

}  // namespace cuscus::netlink
