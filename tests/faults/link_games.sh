# With CAP_NET_ADMIN and CAP_NET_RAW: takes wlan0 down and up, takes another's MAC and address.
# $1: MAC of another UAV; $2: its address; $3: broadcast address.
set -ex
sleep 1
ip link set wlan0 down
sleep 0.5
ip link set wlan0 up
ip link set wlan0 address "$1"
ip address add "$2/16" dev wlan0
ping -c 20 -i 0.02 -b -I "$2" "$3" || true
ip link set wlan0 mtu 600
echo games over
