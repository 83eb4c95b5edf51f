#!/bin/sh
# A keystore of SROS2 for tests: make_keystore.sh FOLDER ENCLAVE...
# One authority; everything signed and encrypted; each enclave may read and write every topic of every domain.
set -eu
keystore=$1
shift
mkdir -p "$keystore/enclaves"
cd "$keystore"
openssl ecparam -name prime256v1 -out curve.pem
openssl req -nodes -x509 -days 2 -newkey ec:curve.pem -keyout ca_key.pem -out ca.pem -subj "/O=tests/CN=authority"
cat > governance.xml <<'XML'
<?xml version="1.0" encoding="UTF-8"?>
<dds>
  <domain_access_rules><domain_rule>
    <domains><id_range><min>0</min><max>230</max></id_range></domains>
    <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
    <enable_join_access_control>true</enable_join_access_control>
    <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
    <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
    <rtps_protection_kind>SIGN</rtps_protection_kind>
    <topic_access_rules><topic_rule>
      <topic_expression>*</topic_expression>
      <enable_discovery_protection>true</enable_discovery_protection>
      <enable_liveliness_protection>true</enable_liveliness_protection>
      <enable_read_access_control>true</enable_read_access_control>
      <enable_write_access_control>true</enable_write_access_control>
      <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
      <data_protection_kind>ENCRYPT</data_protection_kind>
    </topic_rule></topic_access_rules>
  </domain_rule></domain_access_rules>
</dds>
XML
openssl smime -sign -in governance.xml -text -out governance.p7s -signer ca.pem -inkey ca_key.pem
for enclave in "$@"; do
    folder=enclaves/$enclave
    mkdir "$folder"
    openssl req -nodes -newkey ec:curve.pem -keyout "$folder/key.pem" -out request.pem -subj "/O=tests/CN=$enclave"
    openssl x509 -req -days 2 -in request.pem -CA ca.pem -CAkey ca_key.pem -CAcreateserial -out "$folder/cert.pem"
    name=$(openssl x509 -in "$folder/cert.pem" -noout -subject -nameopt RFC2253 | sed 's/subject=//')
    cat > permissions.xml <<XML
<?xml version="1.0" encoding="UTF-8"?>
<dds>
  <permissions><grant name="/$enclave">
    <subject_name>$name</subject_name>
    <validity><not_before>2020-01-01T00:00:00</not_before><not_after>2099-01-01T00:00:00</not_after></validity>
    <allow_rule>
      <domains><id_range><min>0</min><max>230</max></id_range></domains>
      <publish><topics><topic>*</topic></topics></publish>
      <subscribe><topics><topic>*</topic></topics></subscribe>
    </allow_rule>
    <default>DENY</default>
  </grant></permissions>
</dds>
XML
    openssl smime -sign -in permissions.xml -text -out "$folder/permissions.p7s" -signer ca.pem -inkey ca_key.pem
    cp governance.p7s "$folder/"
    cp ca.pem "$folder/identity_ca.cert.pem"
    cp ca.pem "$folder/permissions_ca.cert.pem"
done
