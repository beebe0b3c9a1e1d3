#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes the certificates of sessions over a network (vps ... --network INTERFACE --security FOLDER).
#
#     scenes/make_certificates.sh keys render device watch
#
# makes the folders keys/render, keys/device and keys/watch, one for each node, and keys/authority. The machine of a node needs
# the folder of its node only. keys/authority stays here; with it, certificates for more nodes can be made later. The start of a
# node's name determines its rights: render..., device..., watch... or operate... (vps ask); a watcher can change nothing. Copy
# the folders over a channel that nobody else can read.
set -euo pipefail
[ $# -ge 2 ] || { sed -n '3,10s/^# \{0,1\}//p' "$0"; exit 2; }
out=$1; shift
umask 077
authority=$out/authority
days=3650

subject() { printf '/CN=%s' "$1"; }

new_key() { openssl ecparam -name prime256v1 -genkey -noout -out "$1"; }

sign() { # FILE.xml FILE.p7s
  openssl smime -sign -in "$1" -text -out "$2" -signer "$authority/ca.pem" -inkey "$authority/key.pem" 2>/dev/null
}

make_authority() {
  mkdir -p "$authority"
  new_key "$authority/key.pem"
  openssl req -x509 -new -key "$authority/key.pem" -sha256 -days $days -subj "$(subject "vps authority $(openssl rand -hex 8)")" \
    -out "$authority/ca.pem"
  cat >"$authority/governance.xml" <<'XML'
<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_governance.xsd">
  <domain_access_rules>
    <domain_rule>
      <domains><id_range><min>0</min><max>230</max></id_range></domains>
      <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
      <enable_join_access_control>true</enable_join_access_control>
      <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
      <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
      <rtps_protection_kind>NONE</rtps_protection_kind>
      <topic_access_rules>
        <topic_rule>
          <topic_expression>*</topic_expression>
          <enable_discovery_protection>true</enable_discovery_protection>
          <enable_liveliness_protection>true</enable_liveliness_protection>
          <enable_read_access_control>true</enable_read_access_control>
          <enable_write_access_control>true</enable_write_access_control>
          <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
          <data_protection_kind>NONE</data_protection_kind>
        </topic_rule>
      </topic_access_rules>
    </domain_rule>
  </domain_access_rules>
</dds>
XML
  sign "$authority/governance.xml" "$authority/governance.p7s"
}

topics() { for topic in "$@"; do printf '<topic>%s</topic>' "$topic"; done; }

# Each topic has one role that writes it (scenes/network/src/link/link.h). A watcher may write a pointer, which the other watchers see.
written_by() {
  case $1 in
    render*) topics 'vps/*/beat' 'vps/*/scene' 'vps/*/physics' 'vps/*/physics_state' 'vps/*/snapshot' 'vps/*/request' 'vps/*/news' 'vps/*/answer' ;;
    device*) topics 'vps/*/beat' 'vps/*/haptic' 'vps/*/haptic_state' 'vps/*/reply' 'vps/*/log' 'vps/*/pointer' ;;  # device nodes of web pages with a hand write pointers too
    watch*) topics 'vps/*/beat' 'vps/*/pointer' ;;
    operate*) topics 'vps/*/ask' ;;
    *) echo "make_certificates.sh: $1 must begin with render, device, watch or operate" >&2; exit 2 ;;
  esac
}

make_node() {
  local node=$1 folder=$out/$1 writes from until
  writes=$(written_by "$node")
  mkdir -p "$folder"
  new_key "$folder/key.pem"
  openssl req -new -key "$folder/key.pem" -subj "$(subject "$node")" -out "$folder/request.pem"
  openssl x509 -req -in "$folder/request.pem" -CA "$authority/ca.pem" -CAkey "$authority/key.pem" -CAcreateserial \
    -days $days -sha256 -out "$folder/identity.pem" 2>/dev/null
  rm "$folder/request.pem"
  from=$(date -u -d yesterday +%Y-%m-%dT%H:%M:%S)
  until=$(date -u -d "$days days" +%Y-%m-%dT%H:%M:%S)
  cat >"$folder/permissions.xml" <<XML
<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_permissions.xsd">
  <permissions>
    <grant name="$node">
      <subject_name>CN=$node</subject_name>
      <validity><not_before>$from</not_before><not_after>$until</not_after></validity>
      <allow_rule>
        <domains><id_range><min>0</min><max>230</max></id_range></domains>
        <publish><topics>$writes</topics></publish>
        <subscribe><topics><topic>vps/*</topic></topics></subscribe>
      </allow_rule>
      <default>DENY</default>
    </grant>
  </permissions>
</dds>
XML
  sign "$folder/permissions.xml" "$folder/permissions.p7s"
  cp "$authority/ca.pem" "$authority/governance.p7s" "$folder/"
  echo "$folder"
}

for node in "$@"; do written_by "$node" >/dev/null; done
[ -e "$authority/key.pem" ] || make_authority
for node in "$@"; do make_node "$node"; done
