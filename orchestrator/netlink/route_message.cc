#include "orchestrator/netlink/route_message.h"

#include <linux/netlink.h>

#include <new>

namespace cuscus::netlink {
namespace {

/// libnl fails only where memory does: a message is one page, and the longest here is 300 B.
void require(bool done) {
  if (!done) {
    throw std::bad_alloc{};
  }
}

}  // namespace

RouteMessage::RouteMessage(int type, int flags)
    : message_{::nlmsg_alloc_simple(type, flags | NLM_F_REQUEST)} {
  require(message_ != nullptr);
}

void RouteMessage::append_header(void* header, std::size_t size) {
  require(::nlmsg_append(message_.get(), header, size, NLMSG_ALIGNTO) == 0);
}

RouteMessage& RouteMessage::put(int attribute, std::span<const std::uint8_t> bytes) {
  require(::nla_put(message_.get(), attribute, static_cast<int>(bytes.size()), bytes.data()) == 0);
  return *this;
}

RouteMessage& RouteMessage::put_u8(int attribute, std::uint8_t value) {
  require(::nla_put_u8(message_.get(), attribute, value) == 0);
  return *this;
}

RouteMessage& RouteMessage::put_u32(int attribute, std::uint32_t value) {
  require(::nla_put_u32(message_.get(), attribute, value) == 0);
  return *this;
}

RouteMessage& RouteMessage::put_text(int attribute, const std::string& text) {
  require(::nla_put_string(message_.get(), attribute, text.c_str()) == 0);
  return *this;
}

nlattr* RouteMessage::begin_nest(int attribute) {
  nlattr* const start = ::nla_nest_start(message_.get(), attribute);
  require(start != nullptr);
  return start;
}

std::span<const std::uint8_t> RouteMessage::bytes() noexcept {
  const nlmsghdr& header = *::nlmsg_hdr(message_.get());
  return {reinterpret_cast<const std::uint8_t*>(&header), header.nlmsg_len};
}

}  // namespace cuscus::netlink
