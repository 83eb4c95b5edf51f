// The live data: Foxglove's WebSocket protocol, as a client that only listens and, with a bag, drives the player.

/** Subprotocol of the server. */
const PROTOCOL = "foxglove.sdk.v1";
/** Time between attempts to connect (ms): less than the two seconds within which a return is to be seen. */
const RETRY = 1000;

/** One channel that the server offers. */
interface Channel {
  id: number;
  topic: string;
  schemaName: string;
}

/** The player's state, in bag mode. */
export interface Playback {
  playing: boolean;
  ended: boolean;
  /** Time in the bag (ns). */
  time: bigint;
  speed: number;
  /** Whether the player has reported this; otherwise it follows from the time that advances. */
  reported: boolean;
}

export interface Listener {
  /** The connection opened or closed. Nothing is subscribed to before {@link Connection.admit}. */
  onConnected(connected: boolean): void;
  /** A message of a topic (without namespace) with its schema and time (ns). */
  onMessage(topic: string, schema: string, time: bigint, data: DataView): void;
  onPlayback(playback: Playback): void;
}

/** Keeps one connection open for as long as the page is open. */
export class Connection {
  private socket: WebSocket | null = null;
  private topics = new Map<number, { topic: string; schema: string }>();
  private nextId = 1;
  private playback: Playback = { playing: false, ended: false, time: 0n, speed: 1, reported: false };
  private requests = 0;
  /** Channels that the server offers and that are not subscribed to yet. */
  private offered: Channel[] = [];
  private admitted = false;

  constructor(
    private readonly url: string,
    /** Topics to subscribe to, without namespace. */
    private readonly wanted: readonly string[],
    private readonly listener: Listener,
  ) {
    this.connect();
  }

  private connect(): void {
    const socket = new WebSocket(this.url, [PROTOCOL]);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    this.topics.clear();
    this.offered = [];
    this.admitted = false;
    this.playback.reported = false;
    socket.onopen = () => this.listener.onConnected(true);
    socket.onclose = () => {
      this.listener.onConnected(false);
      setTimeout(() => this.connect(), RETRY);
    };
    socket.onmessage = (event) => {
      if (typeof event.data === "string") this.text(JSON.parse(event.data));
      else this.binary(new DataView(event.data as ArrayBuffer));
    };
  }

  private text(message: { op: string; channels?: Channel[]; channelIds?: number[] }): void {
    if (message.op !== "advertise") return;
    this.offered.push(...(message.channels ?? []));
    if (this.admitted) this.subscribe();
  }

  /** Accepts the server as the one that the page is bound to, and subscribes to its topics. */
  admit(): void {
    this.admitted = true;
    this.subscribe();
  }

  private subscribe(): void {
    const subscriptions = [];
    for (const channel of this.offered.splice(0)) {
      const topic = this.wanted.find((name) => channel.topic === `/${name}` || channel.topic.endsWith(`/${name}`));
      if (topic === undefined) continue;
      const id = this.nextId++;
      this.topics.set(id, { topic, schema: channel.schemaName });
      subscriptions.push({ id, channelId: channel.id });
    }
    if (subscriptions.length > 0) this.socket?.send(JSON.stringify({ op: "subscribe", subscriptions }));
  }

  private binary(view: DataView): void {
    switch (view.getUint8(0)) {
      case 0x01: {
        const channel = this.topics.get(view.getUint32(1, true));
        if (!channel) return;
        const data = new DataView(view.buffer, view.byteOffset + 13, view.byteLength - 13);
        this.listener.onMessage(channel.topic, channel.schema, view.getBigUint64(5, true), data);
        return;
      }
      case 0x02: {
        const time = view.getBigUint64(1, true);
        // The player reports changes only; until the first, a time that advances means that it plays.
        const advances = !this.playback.reported && this.playback.time !== 0n && time > this.playback.time;
        this.playback = { ...this.playback, time, playing: this.playback.playing || advances };
        this.listener.onPlayback(this.playback);
        return;
      }
      case 0x05: {
        const status = view.getUint8(1);
        this.playback = {
          playing: status === 0,
          ended: status === 3,
          time: view.getBigUint64(2, true),
          speed: view.getFloat32(10, true),
          reported: true,
        };
        this.listener.onPlayback(this.playback);
        return;
      }
    }
  }

  /** Asks the player of a bag to play or pause, at a speed, from a time (ns) or from its present time. */
  play(playing: boolean, speed: number, seek: bigint | null): void {
    if (this.socket?.readyState !== WebSocket.OPEN) return;
    const id = new TextEncoder().encode(`page-${++this.requests}`);
    const view = new DataView(new ArrayBuffer(19 + id.length));
    view.setUint8(0, 0x03);
    view.setUint8(1, playing ? 0 : 1);
    view.setFloat32(2, speed, true);
    view.setUint8(6, seek === null ? 0 : 1);
    view.setBigUint64(7, seek ?? 0n, true);
    view.setUint32(15, id.length, true);
    new Uint8Array(view.buffer, 19).set(id);
    this.socket.send(view.buffer);
  }
}
