"""One HTTP request: http_client.py METHOD URL [HEADER=VALUE...], its body on standard input.

Answers one JSON object: code, headers, body; of the binary history its head and the first and last frame instead.
"""

import json
import struct
import sys
import urllib.error
import urllib.request


def history(body):
    length = struct.unpack_from("<I", body)[0]
    assert (4 + length) % 8 == 0
    head = json.loads(body[4 : 4 + length])
    stride, count = head["stride"], head["count"]
    numbers = struct.unpack(f"<{stride * count}f", body[4 + length :])
    # NaN is not JSON.
    frames = [[None if x != x else x for x in numbers[index * stride : (index + 1) * stride]] for index in range(count)]
    times = [frame[0] for frame in frames]
    assert all(later > earlier for earlier, later in zip(times, times[1:])), times
    return {"head": head, "first": frames[0], "last": frames[-1], "frames": frames}


def main():
    method, url, *headers = sys.argv[1:]
    body = sys.stdin.read().encode()
    request = urllib.request.Request(url, method=method, data=body or None)
    for header in headers:
        request.add_header(*header.split("=", 1))
    try:
        response = urllib.request.urlopen(request, timeout=20)
    except urllib.error.HTTPError as error:
        response = error
    content = response.read()
    answer = {"code": response.status, "headers": {name.lower(): value for name, value in response.headers.items()}}
    kind = answer["headers"].get("content-type", "")
    if kind == "application/octet-stream":
        answer["history"] = history(content)
    elif kind == "application/json":
        answer["body"] = json.loads(content)
    else:
        answer["body"] = content.decode(errors="replace")
    print(json.dumps(answer))


if __name__ == "__main__":
    main()
