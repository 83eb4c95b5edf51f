//! The broker: its address, the user there, encryption, and what to do when a connection fails.

use std::fmt;
use std::io;
use std::time::Duration;

use rumqttc::tokio_rustls::rustls::{self, CertificateError};
use rumqttc::{ConnectReturnCode, ConnectionError, Error, MqttOptions, QoS, StateError, TlsError, Transport};
use tokio::net::TcpStream;

use super::{LARGEST_PAYLOAD, Message};

/// A lost broker is noticed after twice this time without an answer; the broker publishes the will after one and a half.
const KEEP_ALIVE_S: u16 = 10;
/// Largest packet that is accepted (bytes); commands are a hundred.
const LARGEST_INCOMING: usize = 64 * 1024;
/// What a packet has besides its payload, at most (bytes).
const PACKET_HEADER: usize = 1024;

/// Encryption of the connection.
#[derive(Clone, Default, PartialEq, Eq)]
pub enum Tls {
    /// None.
    #[default]
    None,
    /// TLS; the certificate of the broker must come from an authority that this system trusts.
    System,
    /// TLS; it must come from an authority in this file (PEM).
    Authority(Vec<u8>),
}

/// A broker and the user there.
#[derive(Clone)]
pub struct Broker {
    host: String,
    port: u16,
    tls: Tls,
    user: Option<(String, Vec<u8>)>,
}

impl fmt::Debug for Broker {
    // Without the password.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

impl fmt::Display for Broker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.host.contains(':') {
            write!(f, "[{}]:{}", self.host, self.port)
        } else {
            write!(f, "{}:{}", self.host, self.port)
        }
    }
}

/// Why a broker cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum BrokerError {
    /// The address is none.
    #[error("{text:?} is no address of a broker: {why}; HOST, HOST:PORT or [IPv6]:PORT, such as 192.168.1.5:1883")]
    Address {
        /// As given.
        text: String,
        /// What is wrong.
        why: &'static str,
    },
    /// The authorities cannot be used.
    #[error(
        "the certificates of the authorities cannot be used: {why}; a PEM file begins with -----BEGIN CERTIFICATE-----"
    )]
    Authority {
        /// The reason, in words for a log.
        why: String,
    },
    /// The system's authorities cannot be read.
    #[error("the system's certificates cannot be read: {why}; install the package ca-certificates or name a file")]
    SystemCertificates {
        /// The reason, in words for a log.
        why: String,
    },
}

impl Broker {
    /// A broker by `HOST`, `HOST:PORT` or `[IPv6]:PORT`. The usual port is 1883, and 8883 with TLS.
    ///
    /// # Errors
    /// When the text is no address or the authorities cannot be used.
    pub fn new(text: &str, tls: Tls, user: Option<(String, Vec<u8>)>) -> Result<Self, BrokerError> {
        // The text is in every error, because options may come from a service file that the reader does not see.
        let wrong = |why| BrokerError::Address {
            text: text.to_owned(),
            why,
        };
        // Only IPv6 has brackets: without them its colons could not be distinguished from that of the port.
        let (host, port) = match text.strip_prefix('[') {
            Some(rest) => {
                let (host, port) = rest.split_once(']').ok_or_else(|| wrong("the bracket is not closed"))?;
                let port = match port {
                    "" => None,
                    _ => Some(
                        port.strip_prefix(':')
                            .ok_or_else(|| wrong("a colon must follow the bracket"))?,
                    ),
                };
                if host.parse::<std::net::Ipv6Addr>().is_err() {
                    return Err(wrong("there is no IPv6 address in the brackets"));
                }
                (host, port)
            }
            None => match text.split_once(':') {
                Some((host, port)) => (host, Some(port)),
                None => (text, None),
            },
        };
        // A slash is typically a URL (`mqtt://`), which this option does not take.
        if host.is_empty() || host.chars().any(|c| c.is_whitespace() || c.is_control() || c == '/') {
            return Err(wrong("the host is missing or has a character that no host has"));
        }
        let port = match port {
            // 1883 and 8883 are the registered ports of MQTT without and with TLS.
            None if tls == Tls::None => 1883,
            None => 8883,
            Some(port) => match port.parse() {
                Ok(port) if port > 0 => port,
                _ => return Err(wrong("the port must be 1 to 65535")),
            },
        };
        let broker = Self {
            host: host.to_owned(),
            port,
            tls,
            user,
        };
        // The certificates are tried now, so that a wrong file ends the
        // program at its start and not at the first connection.
        broker.transport()?;
        Ok(broker)
    }

    /// Whether a password would cross a network unencrypted.
    pub fn exposes_password(&self) -> bool {
        let is_here = self.host == "localhost"
            || self
                .host
                .parse::<std::net::IpAddr>()
                .is_ok_and(|address| address.is_loopback());
        self.user.is_some() && self.tls == Tls::None && !is_here
    }

    /// Whether the connection is encrypted.
    pub fn is_encrypted(&self) -> bool {
        self.tls != Tls::None
    }

    fn transport(&self) -> Result<Transport, BrokerError> {
        match &self.tls {
            Tls::None => Ok(Transport::Tcp),
            Tls::System => Transport::try_tls_with_default_config()
                .map_err(|error| BrokerError::SystemCertificates { why: error.to_string() }),
            Tls::Authority(pem) => {
                use rustls::pki_types::{CertificateDer, pem::PemObject as _};
                let wrong = |why| BrokerError::Authority { why };
                let mut found = 0;
                let mut roots = rustls::RootCertStore::empty();
                for certificate in CertificateDer::pem_slice_iter(pem) {
                    let certificate = certificate.map_err(|error| wrong(error.to_string()))?;
                    roots.add(certificate).map_err(|error| wrong(error.to_string()))?;
                    found += 1;
                }
                if found == 0 {
                    return Err(wrong("there is none in the file".to_owned()));
                }
                Ok(Transport::tls(pem.clone(), None, None))
            }
        }
    }

    pub(super) fn options(
        &self,
        client_id: &str,
        will: Message,
        connect: Duration,
    ) -> Result<MqttOptions, BrokerError> {
        let mut options = MqttOptions::new(client_id, rumqttc::Broker::tcp(self.host.clone(), self.port));
        options.set_transport(self.transport()?);
        options.set_keep_alive(KEEP_ALIVE_S);
        options.set_clean_session(true);
        options.set_max_packet_size(LARGEST_INCOMING, LARGEST_PAYLOAD + PACKET_HEADER);
        options.set_last_will(rumqttc::LastWill::new(
            will.topic,
            will.payload,
            QoS::AtLeastOnce,
            will.retained,
        ));
        if let Some((user, password)) = &self.user {
            options.set_credentials(user.clone(), password.clone());
        }
        let (host, port) = (self.host.clone(), self.port);
        // The library joins host and port to one text, which an IPv6 address does not survive.
        options.set_socket_connector(move |_, _| {
            let host = host.clone();
            async move {
                let connecting = tokio::time::timeout(connect, TcpStream::connect((host.as_str(), port)));
                let stream = connecting.await.map_err(|_| {
                    io::Error::new(
                        io::ErrorKind::TimedOut,
                        format!("no answer within {} s", connect.as_secs_f64()),
                    )
                })??;
                stream.set_nodelay(true)?;
                Ok(stream)
            }
        });
        Ok(options)
    }

    /// Why a connection failed, and what to do.
    pub(super) fn explained(&self, error: &ConnectionError, was_connected: bool) -> String {
        let closed = "the broker closed the connection";
        match error {
            // The broker's own reason comes first: it is the only one that a user can act on directly.
            ConnectionError::ConnectionRefused(code) => match code {
                ConnectReturnCode::BadUserNamePassword | ConnectReturnCode::NotAuthorized => match &self.user {
                    Some((user, _)) => {
                        format!(
                            "the broker refuses the user {user:?} or its password; check --user and --password-file"
                        )
                    }
                    None => "the broker requires a user; give --user and --password-file".to_owned(),
                },
                ConnectReturnCode::BadClientId => {
                    "the broker refuses the name of the client; give another one with --client-id".to_owned()
                }
                _ => format!("the broker refuses the connection ({code:?})"),
            },
            // Errors of the socket may be wrapped by TLS or not. Both mean the same to the user.
            ConnectionError::Tls(TlsError::Io(error)) | ConnectionError::Io(error) => self.explained_io(error),
            ConnectionError::Tls(error) => format!("TLS failed: {error}"),
            ConnectionError::NetworkTimeout => "no answer in time".to_owned(),
            ConnectionError::FlushTimeout => "the broker takes no data".to_owned(),
            // A ping is sent after each keep-alive without traffic, and the answer may take as long again.
            ConnectionError::MqttState(StateError::AwaitPingResp) => {
                format!("no sign of life from the broker for {} s", 2 * KEEP_ALIVE_S)
            }
            ConnectionError::MqttState(StateError::ConnectionAborted) if was_connected => closed.to_owned(),
            // An end without an answer is what a port with TLS does to a client without.
            ConnectionError::MqttState(StateError::ConnectionAborted) => {
                format!("{closed} without an answer{}", self.tls_hint())
            }
            // `Other` is an end within what was taken for a packet.
            // Before the first packet these errors depend on what listens there, so the hint on TLS is added only then.
            ConnectionError::MqttState(StateError::Deserialization(Error::Io(error)) | StateError::Io(error))
                if was_connected || error.kind() != io::ErrorKind::Other =>
            {
                let hint = if was_connected { "" } else { self.tls_hint() };
                format!("the connection broke: {error}{hint}")
            }
            // An answer that is no CONNACK: another service listens on this port.
            ConnectionError::NotConnAck(_) | ConnectionError::MqttState(StateError::Deserialization(_))
                if !was_connected =>
            {
                let hint = self.tls_hint();
                format!("what answers at {self} speaks no MQTT 3.1.1 ({error}); check --broker{hint}")
            }
            _ => error.to_string(),
        }
    }

    /// What an answer that cannot be understood may mean.
    fn tls_hint(&self) -> &'static str {
        match self.tls {
            Tls::None => "; if this port expects TLS, give --tls-ca or --tls",
            Tls::System | Tls::Authority(_) => "",
        }
    }

    fn explained_io(&self, error: &io::Error) -> String {
        let tls = error.get_ref().and_then(|inner| inner.downcast_ref::<rustls::Error>());
        match (tls, error.kind()) {
            (Some(rustls::Error::InvalidCertificate(why)), _) => match why {
                CertificateError::UnknownIssuer | CertificateError::BadSignature => {
                    "the broker's certificate is from none of the trusted authorities; check --tls-ca".to_owned()
                }
                CertificateError::NotValidForName | CertificateError::NotValidForNameContext { .. } => format!(
                    "the broker's certificate is not for {:?}; name the broker in --broker as its certificate does",
                    self.host
                ),
                CertificateError::Expired | CertificateError::ExpiredContext { .. } => {
                    "the broker's certificate has expired, or the clock of this machine is wrong".to_owned()
                }
                why => format!("the broker's certificate is not valid: {why}"),
            },
            (Some(rustls::Error::InvalidMessage(_)), _) => {
                format!("what answers at {self} speaks no TLS; check the port, or leave out --tls-ca and --tls")
            }
            (Some(error), _) => format!("TLS failed: {error}"),
            (None, io::ErrorKind::ConnectionRefused) => {
                format!("nothing listens at {self}; check --broker and that the broker runs")
            }
            (None, io::ErrorKind::UnexpectedEof) if self.tls != Tls::None => {
                "the broker closed the connection during the TLS handshake; check that this port expects TLS".to_owned()
            }
            // The standard library gives a failed look-up no kind of its own.
            (None, _) if error.to_string().contains("lookup") => {
                format!("the host {:?} cannot be found ({error}); check --broker", self.host)
            }
            (None, _) => error.to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_with_their_usual_ports() {
        let shown = |text: &str, tls: Tls| Broker::new(text, tls, None).unwrap().to_string();
        assert_eq!(shown("broker", Tls::None), "broker:1883");
        assert_eq!(shown("broker", Tls::System), "broker:8883");
        assert_eq!(shown("10.0.0.5:2000", Tls::None), "10.0.0.5:2000");
        assert_eq!(shown("[::1]:2000", Tls::None), "[::1]:2000");
        assert_eq!(shown("[::1]", Tls::None), "[::1]:1883");
        for wrong in [
            "",
            ":1883",
            "a:0",
            "a:65536",
            "a:b",
            "[::1",
            "[::1]x",
            "[a]:1",
            "::1",
            "a b",
            "mqtt://a:1883",
        ] {
            let error = Broker::new(wrong, Tls::None, None).unwrap_err().to_string();
            assert!(error.contains("HOST:PORT"), "{wrong}: {error}");
        }
        let error = Broker::new("a", Tls::Authority(b"no PEM".to_vec()), None).unwrap_err();
        assert!(error.to_string().contains("BEGIN CERTIFICATE"), "{error}");
    }

    #[test]
    fn a_password_is_not_shown_and_its_exposure_is_known() {
        let user = Some(("rig".to_owned(), b"secret".to_vec()));
        let broker = |host: &str, tls: Tls| Broker::new(host, tls, user.clone()).unwrap();
        assert!(!format!("{:?}", broker("10.0.0.5", Tls::None)).contains("secret"));
        assert!(broker("10.0.0.5", Tls::None).exposes_password());
        assert!(!broker("localhost", Tls::None).exposes_password());
        assert!(!broker("127.0.0.1", Tls::None).exposes_password());
    }
}
