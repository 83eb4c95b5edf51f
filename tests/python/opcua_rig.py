"""A rig's server of OPC UA by others (asyncua), for crates/flexdrill-bridge/tests/opcua and tests/node/opcua.rs.

opcua_rig.py PORT serves HookLoad, Speed and Weight in urn:rig at opc.tcp://127.0.0.1:PORT; 0 takes a free port. It prints
its port, and then reads lines NAME VALUE [STATUS]; the end of its input ends it. 77: no asyncua.
"""

import asyncio
import logging
import sys
from datetime import datetime, timezone

try:
    from asyncua import Server, ua
except ImportError as error:
    print(f"no asyncua: {error}", flush=True)
    sys.exit(77)


async def main():
    logging.disable(logging.CRITICAL)
    server = Server()
    await server.init()
    server.set_endpoint(f"opc.tcp://127.0.0.1:{sys.argv[1]}")
    server.set_security_policy([ua.SecurityPolicyType.NoSecurity])
    index = await server.register_namespace("urn:rig")
    nodes = {}
    for name in ["HookLoad", "Speed", "Weight"]:
        node = ua.NodeId(f"Rig.{name}", index)
        nodes[name] = await server.nodes.objects.add_variable(node, name, 0.0, ua.VariantType.Double)
    loop = asyncio.get_running_loop()
    async with server:
        port = server.bserver._server.sockets[0].getsockname()[1]
        print(port, flush=True)
        while line := await loop.run_in_executor(None, sys.stdin.readline):
            name, value, *status = line.split()
            number = None if value == "none" else ua.Variant(float(value), ua.VariantType.Double)
            code = ua.StatusCode(getattr(ua.StatusCodes, status[0])) if status else ua.StatusCode(0)
            now = datetime.now(timezone.utc).replace(tzinfo=None)
            await server.write_attribute_value(
                nodes[name].nodeid, ua.DataValue(number or ua.Variant(), code, now, now)
            )
            print("done", flush=True)


asyncio.run(main())
