#include <arpa/inet.h>
#include <linux/if_ether.h>
#include <linux/pkt_cls.h>
#include <linux/pkt_sched.h>
#include <linux/rtnetlink.h>

#include <utility>

#include "orchestrator/netlink/route_socket.h"

namespace cuscus::netlink {

void RouteSocket::add_clsact(std::uint32_t link_index) {
  tcmsg header{};
  header.tcm_ifindex = static_cast<int>(link_index);
  header.tcm_parent = TC_H_CLSACT;
  header.tcm_handle = TC_H_MAKE(TC_H_CLSACT, 0U);
  RouteMessage message{RTM_NEWQDISC, NLM_F_CREATE | NLM_F_EXCL, header};
  message.put_text(TCA_KIND, "clsact");
  transact(std::move(message), "add a clsact qdisc");
}

void RouteSocket::add_egress_program(std::uint32_t link_index, int program_fd,
                                     const std::string& name) {
  constexpr std::uint32_t kPriority = 1;
  tcmsg header{};
  header.tcm_ifindex = static_cast<int>(link_index);
  header.tcm_parent = TC_H_MAKE(TC_H_CLSACT, TC_H_MIN_EGRESS);
  header.tcm_info = TC_H_MAKE(kPriority << 16U, htons(ETH_P_ALL));
  RouteMessage message{RTM_NEWTFILTER, NLM_F_CREATE | NLM_F_EXCL, header};
  message.put_text(TCA_KIND, "bpf").nest(TCA_OPTIONS, [&] {
    message.put_u32(TCA_BPF_FD, static_cast<std::uint32_t>(program_fd))
        .put_text(TCA_BPF_NAME, name)
        .put_u32(TCA_BPF_FLAGS, TCA_BPF_FLAG_ACT_DIRECT);
  });
  transact(std::move(message), "attach a BPF program to an egress");
}

}  // namespace cuscus::netlink
