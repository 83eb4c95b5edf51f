"""A client of OPC UA by others (asyncua), for crates/flexdrill-bridge/tests/opcua.

opcua_client.py TASK URL [ARGUMENT ...] does the task and prints what it saw as one JSON document. 77: no asyncua.
"""

import asyncio
import json
import sys
from datetime import timezone
from pathlib import Path

try:
    from asyncua import Client, ua
    from asyncua.common.events import get_filter_from_event_type
    from asyncua.crypto.cert_gen import setup_self_signed_certificate
    from asyncua.crypto.security_policies import SecurityPolicyBasic256Sha256
    from cryptography.x509.oid import ExtendedKeyUsageOID
except ImportError as error:
    print(f"no asyncua: {error}")
    sys.exit(77)

NAMESPACE = "urn:flexdrill:twin"
LIMIT = 60


async def refused(doing):
    """The name of the status that something is refused with; empty where it is not."""
    try:
        await doing
    except ua.UaError as error:
        return type(error).__name__
    except (ConnectionError, asyncio.TimeoutError) as error:
        return f"connection: {type(error).__name__}"
    return ""


def in_words(value):
    """A value as JSON has it."""
    if isinstance(value, ua.LocalizedText):
        return value.Text
    if isinstance(value, ua.NodeId):
        return value.to_string()
    if isinstance(value, bytes):
        return value.hex()
    if hasattr(value, "isoformat"):
        return value.isoformat()
    return value


class Space:
    """The twin's nodes by their paths."""

    def __init__(self, client, index):
        self.client, self.index = client, index

    @classmethod
    async def of(cls, client):
        return cls(client, await client.get_namespace_index(NAMESPACE))

    def node(self, path):
        return self.client.get_node(ua.NodeId(path, self.index))

    async def read(self, path):
        node = self.node(path)
        value = await node.read_data_value(raise_on_bad_status=False)
        seen = {
            "value": in_words(value.Value.Value) if value.Value else None,
            "status": value.StatusCode.name,
            "time": value.SourceTimestamp.replace(tzinfo=timezone.utc).timestamp() if value.SourceTimestamp else None,
            "type": (await node.read_data_type_as_variant_type()).name,
        }
        for property in await node.get_properties():
            if (await property.read_browse_name()).Name == "EngineeringUnits":
                unit = await property.read_value()
                seen["unit"] = [unit.DisplayName.Text, unit.UnitId, unit.NamespaceUri]
        return seen


async def children(node):
    return sorted([(await child.read_browse_name()).Name for child in await node.get_children()])


async def read(url, *paths):
    """What a client without a password sees, and what it is refused."""
    async with Client(url) as client:
        space = await Space.of(client)
        root = await client.nodes.objects.get_child(f"{space.index}:flexdrill")
        seen = {"folders": await children(root), "alarms": await children(space.node("alarms"))}
        seen["values"] = {path: await space.read(path) for path in paths}
        written = ua.Variant(60.0, ua.VariantType.Double)
        seen["write"] = {
            path: await refused(space.node(path).write_value(ua.DataValue(written)))
            for path in ["targets/rotary_speed", "figures/bit_torque"]
        }
        seen["browse_all"] = len(await client.nodes.objects.get_children())
        return seen


async def write(url, user, password, rotary_speed):
    """What a user may write."""
    client = Client(url)
    client.set_user(user)
    client.set_password(password)
    login = await refused(client.connect())
    if login:
        return {"login": login}
    try:
        space = await Space.of(client)

        async def put(path, value, kind=ua.VariantType.Double):
            return await refused(space.node(path).write_value(ua.DataValue(ua.Variant(value, kind))))

        return {
            "login": "",
            "good": await put("targets/rotary_speed", float(rotary_speed)),
            "nan": await put("targets/rotary_speed", float("nan")),
            "far": await put("targets/weight_on_bit", 1e9),
            "text": await put("targets/weight_on_bit", "90", ua.VariantType.String),
            "figure": await put("figures/bit_torque", 1.0),
            "read": await space.read("targets/rotary_speed"),
        }
    finally:
        await client.disconnect()


class Events:
    """Events as they come."""

    FIELDS = ["EventType", "ConditionName", "Message", "Severity", "Retain", "ActiveState/Id", "AckedState/Id"]

    def __init__(self):
        self.seen = asyncio.Queue()

    def event_notification(self, event):
        self.seen.put_nowait({name: in_words(getattr(event, name, None)) for name in self.FIELDS})

    async def until_end(self):
        """All events until the end of a refresh."""
        seen = []
        while True:
            event = await asyncio.wait_for(self.seen.get(), 10)
            seen.append(event)
            if event["EventType"] == "i=2788":
                return seen


async def conditions(url):
    """The conditions that stand, as a client of Part 9 subscribes to them, and again after ConditionRefresh."""
    async with Client(url) as client:
        space = await Space.of(client)
        events = Events()
        subscription = await client.create_subscription(100, events)
        # async-opcua 0.19 does not compare node ids in lists, by which asyncua asks for types, and leaves out the field of
        # the condition's own id, which has no path.
        types = [client.get_node(ua.ObjectIds.AlarmConditionType)]
        wanted = await get_filter_from_event_type(types, where_clause_generation=False)
        wanted.SelectClauses = [clause for clause in wanted.SelectClauses if clause.BrowsePath]
        await subscription.subscribe_alarms_and_conditions(client.nodes.server, types, wanted, queuesize=20)
        first = await events.until_end()
        condition = client.get_node(ua.ObjectIds.ConditionType)
        identity = ua.Variant(subscription.subscription_id, ua.VariantType.UInt32)
        await condition.call_method("0:ConditionRefresh", identity)
        return {"first": first, "again": await events.until_end(), "index": space.index}


async def encrypted(url, folder, user, password):
    """Reads over an encrypted connection, with a certificate that is made where there is none."""
    folder = Path(folder)
    key, certificate = folder / "key.pem", folder / "certificate.der"
    uri = "urn:test:asyncua"
    await setup_self_signed_certificate(key, certificate, uri, "localhost", [ExtendedKeyUsageOID.CLIENT_AUTH], {})
    client = Client(url)
    client.application_uri = uri
    client.set_user(user)
    client.set_password(password)
    try:
        await client.set_security(SecurityPolicyBasic256Sha256, str(certificate), str(key))
        await client.connect()
    except (ua.UaError, ConnectionError, asyncio.TimeoutError) as error:
        return {"connected": False, "why": type(error).__name__}
    try:
        space = await Space.of(client)
        return {"connected": True, "value": await space.read("figures/bit_torque")}
    finally:
        await client.disconnect()


async def greedy(url):
    """Asks for much: subscriptions, items, and values in one request."""

    class Quiet:
        def datachange_notification(self, node, value, data):
            pass

    async with Client(url) as client:
        space = await Space.of(client)
        subscriptions, why = [], ""
        for _ in range(20):
            try:
                subscriptions.append(await client.create_subscription(100, Quiet()))
            except ua.UaError as error:
                why = type(error).__name__
                break
        node = space.node("figures/bit_torque")
        items, refusals = 0, set()
        for _ in range(12):
            try:
                results = await subscriptions[0].subscribe_data_change([node] * 100, queuesize=1_000_000)
            except ua.UaError as error:
                refusals.add(type(error).__name__)
                continue
            for result in results:
                if isinstance(result, ua.StatusCode):
                    refusals.add(result.name)
                else:
                    items += 1
        asked = [ua.ReadValueId(node.nodeid, ua.AttributeIds.Value)] * 5000
        read = await refused(client.uaclient.read(ua.ReadParameters(NodesToRead=asked)))
        return {
            "subscriptions": len(subscriptions),
            "subscription_refused": why,
            "items": items,
            "item_refused": sorted(refusals),
            "read_refused": read,
        }


async def main():
    task = globals()[sys.argv[1]]
    print(json.dumps(await asyncio.wait_for(task(*sys.argv[2:]), LIMIT)))


asyncio.run(main())
