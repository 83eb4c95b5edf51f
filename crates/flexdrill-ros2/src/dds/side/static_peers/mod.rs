//! Static peers: configured machines that multicast does not reach. Each receives by unicast what DDS here sends by
//! multicast.
//!
//! RustDDS has no static peers. But it announces itself also on 127.0.0.1, at the ports of this machine's first
//! participants. A socket at a free one of these ports receives the announcements, and forwards them to the peers without
//! the multicast group. A participant that receives them answers by unicast, and all of discovery follows by unicast.
//!
//! RustDDS sends samples to a reader's multicast group if the reader has one, and those samples do not reach a peer. They
//! are therefore sent again to each reader of a peer by unicast; readers drop duplicates.

mod announcement;

use std::collections::BTreeSet;
use std::io;
use std::net::{Ipv4Addr, SocketAddr, ToSocketAddrs as _, UdpSocket};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use rustdds::DomainParticipant;
use socket2::{Domain, Protocol, Socket, Type};

use super::locked;
use super::outlet::Outlet;
use super::peers::sockets;
use crate::dds::frames::LogLevel;
use crate::dds::network::Network;
use crate::dds::plan::GuidPrefix;

/// Ports of DDS (RTPS 2.5, 9.6.2.3): the first of a domain, the next domain's distance, and within a domain that of
/// samples by multicast, of the first participant's discovery by unicast, and the next participant's distance.
const FIRST_PORT: u16 = 7400;
const PER_DOMAIN: u16 = 250;
const SAMPLES: u16 = 1;
const DISCOVERY: u16 = 10;
const PER_PARTICIPANT: u16 = 2;
/// Participants of this machine to which RustDDS announces itself (`SPDP_LOCALHOST_PEER_COUNT`).
const LOCAL_PARTICIPANTS: u16 = 12;
/// Participants of a peer to which the announcement is forwarded, as many as rmw_cyclonedds tries.
const PEER_PARTICIPANTS: u16 = 32;
/// How often the announcement is repeated, so that a new peer is found within seconds.
const REPEAT: Duration = Duration::from_secs(2);
/// Shortest time between two announcements: the library announces itself again to each new participant, also to forged ones.
const PAUSE: Duration = Duration::from_millis(200);
/// How often names are resolved again and ports are tried again.
const RETRY: Duration = Duration::from_secs(30);
/// Longest datagram (bytes).
const MOST_BYTES: usize = 1 << 16;

pub(super) struct StaticPeers {
    addresses: Arc<Mutex<Vec<Ipv4Addr>>>,
    readers: Arc<Mutex<Vec<SocketAddr>>>,
}

impl StaticPeers {
    /// Starts to announce this participant to the peers, if there are any.
    ///
    /// # Errors
    /// When a thread or a socket cannot be created.
    pub(super) fn start(network: &Network, own: GuidPrefix, outlet: &Outlet) -> io::Result<Option<Self>> {
        if network.peers.is_empty() {
            return Ok(None);
        }
        let peers = Self {
            addresses: Arc::default(),
            readers: Arc::default(),
        };
        let thread = |name: &str| std::thread::Builder::new().name(name.to_owned());
        let (names, addresses, log) = (network.peers.clone(), Arc::clone(&peers.addresses), outlet.clone());
        thread("peers' names").spawn(move || resolve(&names, &addresses, &log))?;
        let base = FIRST_PORT + PER_DOMAIN * network.domain_id;
        let out = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0))?;
        let announcer = Announcer {
            base,
            own,
            out: out.try_clone()?,
            addresses: Arc::clone(&peers.addresses),
            failing: BTreeSet::new(),
            outlet: outlet.clone(),
        };
        thread("peers").spawn(move || announcer.run())?;
        let samples = samples_socket(base + SAMPLES)?;
        let readers = Arc::clone(&peers.readers);
        thread("peers' samples").spawn(move || forward_samples(&samples, &out, own, &readers))?;
        Ok(Some(peers))
    }

    /// Reads the readers of the peers from discovery.
    pub(super) fn update(&self, participant: &DomainParticipant) {
        let addresses = locked(&self.addresses).clone();
        let reading = participant.discovered_readers();
        let found: BTreeSet<SocketAddr> = reading
            .iter()
            // Readers without a multicast group receive samples by unicast anyway.
            .filter(|reader| !reader.reader_proxy.multicast_locator_list.is_empty())
            .flat_map(|reader| sockets(&reader.reader_proxy.unicast_locator_list))
            .filter(|socket| addresses.iter().any(|address| socket.ip() == *address))
            .collect();
        *locked(&self.readers) = found.into_iter().collect();
    }
}

/// Waits until the last announcement, that this participant leaves, is forwarded.
pub(super) fn wait_for_delivery() {
    std::thread::sleep(PAUSE + PAUSE / 2);
}

/// Keeps the addresses of the names up to date.
fn resolve(names: &[String], addresses: &Mutex<Vec<Ipv4Addr>>, outlet: &Outlet) {
    // Numeric addresses must not wait for a name that is slow to resolve.
    let mut known: Vec<Vec<Ipv4Addr>> = names.iter().map(|name| name.parse().into_iter().collect()).collect();
    *locked(addresses) = known.concat();
    let mut is_logged = vec![false; names.len()];
    loop {
        for (index, name) in names.iter().enumerate() {
            match addresses_of(name) {
                Ok(found) => {
                    known[index] = found;
                    is_logged[index] = false;
                }
                // The former addresses remain.
                Err(why) if !is_logged[index] => {
                    is_logged[index] = true;
                    outlet.log(
                        LogLevel::Warning,
                        format!(
                            "the peer {name} has no IPv4 address: {why}; it is looked up again every {} s",
                            RETRY.as_secs()
                        ),
                    );
                }
                Err(_) => {}
            }
            *locked(addresses) = known.concat();
        }
        std::thread::sleep(RETRY);
    }
}

fn addresses_of(name: &str) -> Result<Vec<Ipv4Addr>, String> {
    let found = (name, 0).to_socket_addrs().map_err(|error| error.to_string())?;
    let found: Vec<Ipv4Addr> = found
        .filter_map(|address| match address {
            SocketAddr::V4(address) => Some(*address.ip()),
            SocketAddr::V6(_) => None,
        })
        .collect();
    if found.is_empty() {
        return Err("IPv6 only, which RustDDS does not speak".to_owned());
    }
    Ok(found)
}

/// Forwards announcements to the peers.
struct Announcer {
    base: u16,
    own: GuidPrefix,
    out: UdpSocket,
    addresses: Arc<Mutex<Vec<Ipv4Addr>>>,
    failing: BTreeSet<Ipv4Addr>,
    outlet: Outlet,
}

impl Announcer {
    fn run(mut self) {
        // The warning comes once; the attempts continue until a port is free.
        let mut is_logged = false;
        let socket = loop {
            // The last port is tried first, because other participants use the first ones.
            let mut ports = (0..LOCAL_PARTICIPANTS).rev().map(|number| self.port(number));
            if let Some(socket) = ports.find_map(|port| UdpSocket::bind((Ipv4Addr::LOCALHOST, port)).ok()) {
                break socket;
            }
            if !is_logged {
                is_logged = true;
                let text = format!(
                    "the peers are not called: all of the UDP ports {} to {} of 127.0.0.1 are in use; too many DDS \
                     programs are on this machine",
                    self.port(0),
                    self.port(LOCAL_PARTICIPANTS - 1)
                );
                self.outlet.log(LogLevel::Warning, text);
            }
            std::thread::sleep(RETRY);
        };
        // The newest announcement is kept for the calls until the next one arrives.
        let mut buffer = vec![0; MOST_BYTES];
        let mut announced: Option<Vec<u8>> = None;
        let (mut called, mut due) = (Instant::now(), Instant::now());
        loop {
            let wait = due.saturating_duration_since(Instant::now());
            // A timeout of zero would mean none.
            let _ = socket.set_read_timeout(Some(wait.max(Duration::from_millis(1))));
            if let Ok(length) = socket.recv(&mut buffer)
                && announcement::is_from(&buffer[..length], &self.own)
            {
                // Without the multicast group, or the peer would answer to where it cannot be heard.
                announced = Some(announcement::without_multicast(&buffer[..length]));
                // A new announcement is forwarded soon, but not more often than `PAUSE`: the library announces itself
                // again to each new participant.
                due = due.min(called + PAUSE);
            }
            let now = Instant::now();
            if now >= due {
                if let Some(announced) = &announced {
                    call_all(
                        &self.out,
                        announced,
                        self.base,
                        &locked(&self.addresses),
                        |address, error| {
                            // A peer that fails is logged once, and again only after it has been reached in between.
                            if error.is_none() {
                                self.failing.remove(&address);
                            } else if let Some(error) = error
                                && self.failing.insert(address)
                            {
                                let text =
                                    format!("the peer {address} cannot be called: {error}; is there a way to it?");
                                self.outlet.log(LogLevel::Warning, text);
                            }
                        },
                    );
                }
                called = now;
                due = now + REPEAT;
            }
        }
    }

    fn port(&self, participant: u16) -> u16 {
        self.base + DISCOVERY + PER_PARTICIPANT * participant
    }
}

fn call_all(
    out: &UdpSocket,
    announced: &[u8],
    base: u16,
    addresses: &[Ipv4Addr],
    mut told: impl FnMut(Ipv4Addr, Option<io::Error>),
) {
    for address in addresses {
        let mut calls = (0..PEER_PARTICIPANTS).map(|participant| {
            let port = base + DISCOVERY + PER_PARTICIPANT * participant;
            out.send_to(announced, (*address, port))
        });
        told(*address, calls.find_map(Result::err));
    }
}

/// Hears what is sent to the group of samples. It need not join it: RustDDS has, at each interface that it uses, and a
/// socket hears what comes in for a group that anybody on the machine has joined.
fn samples_socket(port: u16) -> io::Result<UdpSocket> {
    let socket = Socket::new(Domain::IPV4, Type::DGRAM, Some(Protocol::UDP))?;
    socket.set_reuse_address(true)?;
    socket.set_reuse_port(true)?;
    socket.bind(&SocketAddr::from((Ipv4Addr::UNSPECIFIED, port)).into())?;
    Ok(socket.into())
}

/// Passes on what this participant sends to the group.
fn forward_samples(samples: &UdpSocket, out: &UdpSocket, own: GuidPrefix, readers: &Mutex<Vec<SocketAddr>>) {
    let mut buffer = vec![0; MOST_BYTES];
    let mut last = Vec::new();
    loop {
        let Ok(length) = samples.recv(&mut buffer) else {
            // Nothing that lasts: out of memory for a moment.
            std::thread::sleep(PAUSE);
            continue;
        };
        let message = &buffer[..length];
        // The same comes once for each interface.
        if !announcement::is_from(message, &own) || message == last {
            continue;
        }
        last.clear();
        last.extend_from_slice(message);
        for reader in locked(readers).iter() {
            // Whoever asked for every sample says so when one did not come.
            let _ = out.send_to(message, reader);
        }
    }
}
